#include "proto/error.hpp"
#include "proto/result/field_series.hpp"

namespace proto {

std::size_t n_nodes(CellType type) {
  switch (type) {
    case CellType::vertex:
      return 1;
    case CellType::line:
      return 2;
    case CellType::triangle:
      return 3;
    case CellType::quad:
    case CellType::tetrahedron:
      return 4;
    case CellType::hexahedron:
      return 8;
  }
  throw Error(ExitCode::internal, "unknown cell type", std::to_string(static_cast<int>(type)));
}

OutputMesh OutputMesh::of_one_type(std::vector<double> points, std::vector<std::int64_t> connectivity, CellType type) {
  const std::size_t n_cells = connectivity.size() / n_nodes(type);
  return {std::move(points), std::move(connectivity), std::vector<CellType>(n_cells, type)};
}

}  // namespace proto
