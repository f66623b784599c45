#include "fem_solver/model/irregularity.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double pi = 3.14159265358979323846;

double dipped_joint(const Irregularity& r, double x) {
  const double inside = 1 - 2 * std::abs(x - r.position) / r.length;
  return inside > 0 ? -r.depth * inside * inside : 0.0;
}

double corrugation(const Irregularity& r, double x) {
  const double s = (x - r.position) / r.length;
  if (s <= 0) return 0.0;
  const double fade = s < 1 ? s * s * (3 - 2 * s) : 1.0;
  return r.depth * fade * std::sin(2 * pi * s);
}

double interpolated(const Irregularity& r, double x) {
  if (x <= r.x.front()) return r.height.front();
  if (x >= r.x.back()) return r.height.back();
  const auto i = std::upper_bound(r.x.begin(), r.x.end(), x) - r.x.begin();
  const double s = (x - r.x[i - 1]) / (r.x[i] - r.x[i - 1]);
  return (1 - s) * r.height[i - 1] + s * r.height[i];
}

}  // namespace

double Irregularity::height_at(double position_along_track) const {
  switch (kind) {
    case IrregularityKind::none:
      return 0.0;
    case IrregularityKind::dipped_joint:
      return dipped_joint(*this, position_along_track);
    case IrregularityKind::corrugation:
      return corrugation(*this, position_along_track);
    case IrregularityKind::table:
      return interpolated(*this, position_along_track);
  }
  return 0.0;
}

Irregularity read_irregularity_table(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw proto::Error(proto::ExitCode::missing_input, "cannot read the rail irregularity", path);
  Irregularity table;
  table.kind = IrregularityKind::table;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    line = line.substr(0, line.find('#'));
    std::replace(line.begin(), line.end(), ',', ' ');
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream columns(line);
    double x, height;
    std::string rest;
    const bool read = static_cast<bool>(columns >> x >> height) && !(columns >> rest);
    if (!read || !std::isfinite(x) || !std::isfinite(height) || (!table.x.empty() && x <= table.x.back()))
      throw proto::Error(proto::ExitCode::bad_data,
                         "a line of the irregularity table is not 'x_m, height_m' with ascending x",
                         path + ":" + std::to_string(number));
    table.x.push_back(x), table.height.push_back(height);
  }
  if (table.x.size() < 2)
    throw proto::Error(proto::ExitCode::bad_data, "an irregularity table needs at least two lines", path);
  return table;
}

}  // namespace fem
