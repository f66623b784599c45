#include "proto/result/vtkhdf_group.hpp"

#include <algorithm>
#include <array>

namespace proto::hdf5 {
namespace {

// Version 2.0 of the format is what the first temporal readers (VTK 9.3) ask for; nothing newer is used.
void write_type(OutputFile& file, hid_t group) {
  const std::array<std::int64_t, 2> version{2, 0};
  const hsize_t two = 2;
  const Handle pair(H5Screate_simple(1, &two, nullptr), H5Sclose);
  const Handle number(H5Acreate2(group, "Version", H5T_STD_I64LE, pair.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  file.check(H5Awrite(number.id(), H5T_NATIVE_INT64, version.data()), "write");

  const std::string name = "UnstructuredGrid";  // the readers want a text of fixed length here
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), name.size());
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle text(H5Acreate2(group, "Type", type.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  file.check(H5Awrite(text.id(), type.id(), name.c_str()), "write");
}

std::vector<std::int64_t> offsets_of(const OutputMesh& mesh) {
  std::vector<std::int64_t> offsets{0};
  offsets.reserve(mesh.n_cells() + 1);
  for (const CellType type : mesh.types) offsets.push_back(offsets.back() + static_cast<std::int64_t>(n_nodes(type)));
  return offsets;
}

void check_mesh(const OutputMesh& mesh, const std::vector<std::int64_t>& offsets, const std::string& path) {
  if (mesh.points.size() % 3 != 0) throw Error(ExitCode::internal, "points that are not triples", path);
  if (offsets.back() != static_cast<std::int64_t>(mesh.connectivity.size())) {
    throw Error(ExitCode::internal, "the connectivity does not fit the cell types", path);
  }
  const auto n_points = static_cast<std::int64_t>(mesh.n_points());
  for (const std::int64_t node : mesh.connectivity) {
    if (node < 0 || node >= n_points) {
      throw Error(ExitCode::internal,
                  "a cell refers to point " + std::to_string(node) + " of " + std::to_string(n_points), path);
    }
  }
}

void write_mesh(OutputFile& file, const OutputMesh& mesh) {
  const auto offsets = offsets_of(mesh);
  check_mesh(mesh, offsets, file.path());
  file.write_static("/VTKHDF/Points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {mesh.n_points(), 3}, mesh.points.data(), "m",
                    "reference positions: x along the track, y lateral, z up");
  file.write_static("/VTKHDF/Connectivity", H5T_STD_I64LE, H5T_NATIVE_INT64, {mesh.connectivity.size()},
                    mesh.connectivity.data());
  file.write_static("/VTKHDF/Offsets", H5T_STD_I64LE, H5T_NATIVE_INT64, {offsets.size()}, offsets.data());
  file.write_static("/VTKHDF/Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, {mesh.n_cells()}, mesh.types.data());
}

std::string data_group(Location location) {
  return location == Location::point ? "PointData" : "CellData";
}

std::vector<hsize_t> row_shape_of(std::size_t components) {
  return components == 1 ? std::vector<hsize_t>{} : std::vector<hsize_t>{components};
}

}  // namespace

VtkHdfGroup::VtkHdfGroup(OutputFile& file, const FieldSeriesOptions& options)
    : n_points_(options.mesh.n_points()), n_cells_(options.mesh.n_cells()) {
  const hid_t group = file.create_group("/VTKHDF");
  write_type(file, group);
  write_mesh(file, options.mesh);
  for (const char* name : {"/VTKHDF/PointData", "/VTKHDF/CellData"}) file.create_group(name);
  const hid_t steps = file.create_group("/VTKHDF/Steps");
  for (const char* name : {"/VTKHDF/Steps/PointDataOffsets", "/VTKHDF/Steps/CellDataOffsets"}) file.create_group(name);

  times_ = file.create_dataset({"/VTKHDF/Steps/Values", H5T_IEEE_F64LE, {}, 512, "s", "time of each step"});
  const auto n_ids = static_cast<std::int64_t>(options.mesh.connectivity.size());
  add_bookkeeping(file, "NumberOfPoints", static_cast<std::int64_t>(n_points_), 0);
  add_bookkeeping(file, "NumberOfCells", static_cast<std::int64_t>(n_cells_), 0);
  add_bookkeeping(file, "NumberOfConnectivityIds", n_ids, 0);
  add_bookkeeping(file, "Steps/NumberOfParts", 1, 0);
  // One part, written once: every step reads it from the beginning.
  for (const char* name : {"Steps/PartOffsets", "Steps/PointOffsets"}) add_bookkeeping(file, name, 0, 0);
  for (const char* name : {"Steps/CellOffsets", "Steps/ConnectivityIdOffsets"}) {
    add_bookkeeping(file, name, 0, 0, true);
  }
  for (const FieldColumn& column : options.fields) create_field(file, column);
  for (const StaticField& field : options.static_fields) write_static_field(file, field);
  counter_ = file.create_counter(steps, "NSteps");
}

hid_t VtkHdfGroup::add_bookkeeping(OutputFile& file, const std::string& name, std::int64_t value, std::int64_t advance,
                                   bool as_table) {
  Bookkeeping entry;
  entry.value = value, entry.advance = advance;
  if (as_table) entry.row_shape = {1};
  entry.dataset = file.create_dataset({"/VTKHDF/" + name, H5T_STD_I64LE, entry.row_shape, 512, "", ""});
  bookkeeping_.push_back(entry);
  return entry.dataset;
}

void VtkHdfGroup::create_field(OutputFile& file, const FieldColumn& column) {
  Slot slot;
  slot.column = column;
  slot.n_rows = column.location == Location::point ? n_points_ : n_cells_;
  slot.row_shape = row_shape_of(column.components);
  const std::string path = data_group(column.location) + "/" + column.name;
  slot.dataset = file.create_dataset({"/VTKHDF/" + path, H5T_IEEE_F32LE, slot.row_shape,
                                      std::max<hsize_t>(1, slot.n_rows), column.unit, column.description});
  add_bookkeeping(file, "Steps/" + data_group(column.location) + "Offsets/" + column.name, 0,
                  static_cast<std::int64_t>(slot.n_rows));
  index_[column.name] = slots_.size();
  slots_.push_back(std::move(slot));
}

void VtkHdfGroup::write_static_field(OutputFile& file, const StaticField& field) {
  const FieldColumn& column = field.column;
  const std::size_t n = column.location == Location::point ? n_points_ : n_cells_;
  if (field.values.size() != n * column.components) {
    throw Error(ExitCode::internal, "a static field of the wrong length", column.name);
  }
  std::vector<hsize_t> dims{n};
  for (const hsize_t extent : row_shape_of(column.components)) dims.push_back(extent);
  file.write_static("/VTKHDF/" + data_group(column.location) + "/" + column.name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT,
                    dims, field.values.data(), column.unit, column.description);
  add_bookkeeping(file, "Steps/" + data_group(column.location) + "Offsets/" + column.name, 0, 0);
}

void VtkHdfGroup::continue_from(OutputFile& file, const ResultReader& source, std::uint64_t n_steps) {
  for (std::uint64_t step = 0; step < n_steps; ++step) {
    begin_step(source.read_rows("/VTKHDF/Steps/Values", step, 1).values.front());
    for (const Slot& slot : slots_) {
      const std::string name = "/VTKHDF/" + data_group(slot.column.location) + "/" + slot.column.name;
      const auto values = source.read_rows(name, step * slot.n_rows, slot.n_rows).values;
      put(slot.column.name, std::vector<float>(values.begin(), values.end()));
    }
    file.write(step_bytes(), [&] { write_step(file), mark_committed(file); });
  }
}

void VtkHdfGroup::begin_step(double time) {
  time_ = time;
  for (Slot& slot : slots_) slot.is_put = false;
}

void VtkHdfGroup::put(const std::string& field, Span<const float> values) {
  const auto found = index_.find(field);
  if (found == index_.end()) throw Error(ExitCode::internal, "no such field in the result file", field);
  Slot& slot = slots_[found->second];
  if (values.size() != slot.n_rows * slot.column.components) {
    throw Error(ExitCode::internal, "a field of the wrong length (" + std::to_string(values.size()) + ")", field);
  }
  slot.values.assign(values.begin(), values.end());
  slot.is_put = true;
}

void VtkHdfGroup::require_complete() const {
  if (!time_) throw Error(ExitCode::internal, "a step was ended that was not begun");
  for (const Slot& slot : slots_) {
    if (!slot.is_put) throw Error(ExitCode::internal, "a field was not put before the step ended", slot.column.name);
  }
}

std::uint64_t VtkHdfGroup::step_bytes() const {
  std::uint64_t bytes = 0;
  for (const Slot& slot : slots_) bytes += slot.values.size() * sizeof(float);
  return bytes + bookkeeping_.size() * 512 * sizeof(std::int64_t);
}

void VtkHdfGroup::write_step(OutputFile& file) {
  for (Slot& slot : slots_) {
    file.append_rows(slot.dataset, H5T_NATIVE_FLOAT, slot.row_shape, n_steps_ * slot.n_rows, slot.n_rows,
                     slot.values.data());
  }
  for (const Bookkeeping& entry : bookkeeping_) {
    const std::int64_t value = entry.value + entry.advance * static_cast<std::int64_t>(n_steps_);
    file.append_rows(entry.dataset, H5T_NATIVE_INT64, entry.row_shape, n_steps_, 1, &value);
  }
  file.append_rows(times_, H5T_NATIVE_DOUBLE, {}, n_steps_, 1, &*time_);
}

void VtkHdfGroup::mark_committed(OutputFile& file) {
  file.set_counter(counter_, static_cast<std::int64_t>(++n_steps_));
  time_.reset();
}

}  // namespace proto::hdf5
