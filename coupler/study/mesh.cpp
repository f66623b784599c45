#include "coupler/study/mesh.hpp"

#include <string>

#include "proto/error.hpp"

namespace coupler::study {
namespace {

std::vector<std::uint32_t> indices(const std::vector<double>& values, double limit) {
  std::vector<std::uint32_t> result;
  result.reserve(values.size());
  for (const double value : values) {
    if (!(value >= 0 && value < limit))
      throw proto::Error(proto::ExitCode::bad_data, "a mesh with an index out of range", "/VTKHDF");
    result.push_back(static_cast<std::uint32_t>(value));
  }
  return result;
}

}  // namespace

Mesh read_mesh(const proto::ResultReader& file) {
  Mesh mesh;
  mesh.points = file.read("/VTKHDF/Points").values;
  const auto corners = file.read("/VTKHDF/Connectivity").values;
  mesh.corners = indices(corners, static_cast<double>(mesh.n_points()));
  mesh.offsets = indices(file.read("/VTKHDF/Offsets").values, static_cast<double>(corners.size()) + 1);
  for (const double type : file.read("/VTKHDF/Types").values) mesh.types.push_back(static_cast<std::uint8_t>(type));
  const auto cell_values = [&](const std::string& name) {
    const std::string dataset = "/VTKHDF/CellData/" + name;
    return file.has(dataset) ? file.read(dataset).values : std::vector<double>(mesh.n_cells(), 0.0);
  };
  for (const double body : cell_values("body")) mesh.bodies.push_back(static_cast<std::int64_t>(body));
  for (const double sleeper : cell_values("sleeper")) mesh.sleeper.push_back(sleeper != 0);
  for (const double ground : cell_values("ground")) mesh.ground.push_back(ground != 0);
  bool whole = mesh.offsets.size() == mesh.n_cells() + 1 && mesh.bodies.size() == mesh.n_cells() &&
               mesh.sleeper.size() == mesh.n_cells() && mesh.ground.size() == mesh.n_cells();
  for (std::size_t cell = 0; whole && cell < mesh.n_cells(); ++cell) {
    const std::size_t wanted = mesh.types[cell] == 10 ? 4 : mesh.types[cell] == 12 ? 8 : 0;
    whole = mesh.offsets[cell] + wanted <= mesh.offsets[cell + 1];
  }
  if (!whole) throw proto::Error(proto::ExitCode::bad_data, "a mesh whose arrays do not fit together", "/VTKHDF");
  return mesh;
}

}  // namespace coupler::study
