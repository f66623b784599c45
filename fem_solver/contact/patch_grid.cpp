#include "fem_solver/contact/patch_grid.hpp"

#include <algorithm>

#include "proto/error.hpp"

namespace fem {

PatchBox bounding_box(const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>& inside) {
  const int n_x = static_cast<int>(inside.rows()), n_y = static_cast<int>(inside.cols());
  int i_low = n_x, i_high = -1, j_low = n_y, j_high = -1;
  for (int j = 0; j < n_y; ++j)
    for (int i = 0; i < n_x; ++i) {
      if (!inside(i, j)) continue;
      i_low = std::min(i_low, i), i_high = std::max(i_high, i);
      j_low = std::min(j_low, j), j_high = std::max(j_high, j);
    }
  return i_high < 0 ? PatchBox{} : PatchBox{i_low, j_low, i_high - i_low + 1, j_high - j_low + 1};
}

void require_inside(const PatchField& pressure, const char* where) {
  const bool along = pressure.rows() > 1 && (pressure.row(0).maxCoeff() > 0 || pressure.bottomRows(1).maxCoeff() > 0);
  const bool across = pressure.cols() > 1 && (pressure.col(0).maxCoeff() > 0 || pressure.rightCols(1).maxCoeff() > 0);
  if (along || across)
    throw proto::Error(
        proto::ExitCode::numerics,
        std::string("the contact patch reaches the edge of its grid ") + (along ? "along" : "across") + " the rail",
        where, "raise the grid's margin");
}

}  // namespace fem
