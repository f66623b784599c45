#include "proto/result/xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "proto/error.hpp"
#include "proto/result/field_series.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/text_file.hpp"
#include "proto/result/views_file.hpp"

namespace proto {
namespace {

using hdf5::ViewedField;
using hdf5::ViewedTopology;

/// Everything the sidecar says about a result file.
struct Outline {
  std::string name;  // of the files, without ending
  std::uint64_t n_points = 0, n_cells = 0;
  std::vector<CellType> types;
  std::vector<double> times;
  std::vector<ViewedField> fields;
};

void add_fields(const ResultReader& reader, bool of_points, Outline& outline) {
  const std::string group = of_points ? "/VTKHDF/PointData" : "/VTKHDF/CellData";
  const std::uint64_t n_steps = outline.times.size();
  for (const std::string& name : reader.members(group)) {
    ViewedField field;
    field.name = name, field.of_points = of_points;
    field.n_rows = of_points ? outline.n_points : outline.n_cells;
    const auto shape = reader.shape(field.dataset());
    field.n_stored = shape.at(0);
    field.n_components = shape.size() > 1 ? shape[1] : 1;
    // A dataset that does not grow is a static field.
    field.is_static = !reader.is_extendable(field.dataset());
    if (!field.is_static && field.n_stored < n_steps * field.n_rows) {
      throw Error(ExitCode::bad_data, "a field has fewer rows than steps were committed: " + name, outline.name);
    }
    outline.fields.push_back(field);
  }
}

Outline outline_of(const ResultReader& reader, const std::string& name) {
  Outline outline;
  outline.name = name;
  outline.n_points = reader.shape("/VTKHDF/Points").at(0);
  for (const double type : reader.read("/VTKHDF/Types").values) outline.types.push_back(static_cast<CellType>(type));
  outline.n_cells = outline.types.size();
  outline.times = reader.read_rows("/VTKHDF/Steps/Values", reader.n_steps()).values;
  add_fields(reader, true, outline);
  add_fields(reader, false, outline);
  return outline;
}

bool has_one_type(const Outline& outline) {
  return !outline.types.empty() && std::all_of(outline.types.begin(), outline.types.end(),
                                               [&](CellType type) { return type == outline.types.front(); });
}

const char* xdmf_name(CellType type) {
  static const std::map<CellType, const char*> names{
      {CellType::vertex, "Polyvertex"},  {CellType::line, "Polyline"},           {CellType::triangle, "Triangle"},
      {CellType::quad, "Quadrilateral"}, {CellType::tetrahedron, "Tetrahedron"}, {CellType::hexahedron, "Hexahedron"}};
  return names.at(type);
}

/// The numbers of XDMF for cells in a mixed topology; vertices and lines carry their number of nodes too.
void append_mixed_cell(CellType type, std::vector<std::int64_t>& cells) {
  static const std::map<CellType, int> codes{{CellType::vertex, 1},      {CellType::line, 2},
                                             {CellType::triangle, 4},    {CellType::quad, 5},
                                             {CellType::tetrahedron, 6}, {CellType::hexahedron, 9}};
  cells.push_back(codes.at(type));
  if (type == CellType::vertex || type == CellType::line) {
    cells.push_back(static_cast<std::int64_t>(n_nodes(type)));
  }
}

std::vector<std::int64_t> mixed_cells(const ResultReader& reader, const Outline& outline) {
  const auto connectivity = reader.read("/VTKHDF/Connectivity").values;
  std::vector<std::int64_t> cells;
  std::size_t next = 0;
  for (const CellType type : outline.types) {
    append_mixed_cell(type, cells);
    for (std::size_t node = 0; node < n_nodes(type); ++node) {
      cells.push_back(static_cast<std::int64_t>(connectivity.at(next++)));
    }
  }
  return cells;
}

ViewedTopology topology_of(const ResultReader& reader, const Outline& outline) {
  if (has_one_type(outline)) return {outline.n_cells, n_nodes(outline.types.front()), {}};
  return {outline.n_cells, 0, mixed_cells(reader, outline)};
}

const char* attribute_type(std::uint64_t n_components) {
  switch (n_components) {
    case 1:
      return "Scalar";
    case 3:
      return "Vector";
    case 6:
      return "Tensor6";
    case 9:
      return "Tensor";
    default:
      return "Matrix";
  }
}

std::string data_item(const std::string& place, const std::string& dimensions, const char* kind, int bytes) {
  return fmt::format("<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{}\">{}</DataItem>",
                     kind, bytes, dimensions, place);
}

std::string topology_text(const Outline& outline, const ViewedTopology& topology) {
  const std::string place = outline.name + ".views.h5:/Topology";
  if (!topology.mixed.empty()) {
    return fmt::format("<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">{}</Topology>", outline.n_cells,
                       data_item(place, std::to_string(topology.mixed.size()), "Int", 8));
  }
  const std::size_t n = topology.n_nodes;
  const std::string per_element = n < 3 ? fmt::format(" NodesPerElement=\"{}\"", n) : "";
  return fmt::format("<Topology TopologyType=\"{}\" NumberOfElements=\"{}\"{}>{}</Topology>",
                     xdmf_name(outline.types.front()), outline.n_cells, per_element,
                     data_item(place, fmt::format("{} {}", outline.n_cells, n), "Int", 8));
}

std::string attribute_text(const Outline& outline, const ViewedField& field, std::uint64_t step) {
  const std::string dimensions =
      field.n_components == 1 ? std::to_string(field.n_rows) : fmt::format("{} {}", field.n_rows, field.n_components);
  const std::string place =
      field.is_static ? outline.name + ".h5:" + field.dataset() : outline.name + ".views.h5:" + view_name(field, step);
  return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", field.name,
                     attribute_type(field.n_components), field.of_points ? "Node" : "Cell",
                     data_item(place, dimensions, "Float", 4));
}

std::string xdmf_text(const Outline& outline, const ViewedTopology& topology) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"steps\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  const std::string mesh = fmt::format(
      "        {}\n        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n", topology_text(outline, topology),
      data_item(outline.name + ".h5:/VTKHDF/Points", fmt::format("{} 3", outline.n_points), "Float", 8));
  for (std::size_t step = 0; step < outline.times.size(); ++step) {
    text += fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n        <Time Value=\"{}\"/>\n{}", step,
                        outline.times[step], mesh);
    for (const ViewedField& field : outline.fields) text += attribute_text(outline, field, step);
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace

std::string write_xdmf(const std::string& path) {
  const std::filesystem::path source(path);
  const std::filesystem::path base = source.parent_path() / source.stem();
  const ResultReader reader(path);
  if (!reader.has("/VTKHDF/Steps")) {
    throw Error(ExitCode::bad_data, "a result file without fields", path, "pass qdem.h5 or fem.h5");
  }
  const Outline outline = outline_of(reader, source.stem());
  const ViewedTopology topology = topology_of(reader, outline);

  const std::string views = base.string() + ".views.h5";
  hdf5::write_views(views + ".tmp", source.filename(), outline.fields, outline.times.size(), topology);
  std::error_code failed;
  std::filesystem::rename(views + ".tmp", views, failed);
  if (failed) throw Error(ExitCode::io_error, "cannot rename the file (" + failed.message() + ")", views + ".tmp");
  write_text_file(base.string() + ".xdmf", xdmf_text(outline, topology));
  return base.string() + ".xdmf";
}

}  // namespace proto
