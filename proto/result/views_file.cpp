#include "proto/result/views_file.hpp"

#include "proto/result/output_file.hpp"

namespace proto::hdf5 {
namespace {

std::vector<hsize_t> dims_of(hsize_t rows, hsize_t components) {
  return components == 1 ? std::vector<hsize_t>{rows} : std::vector<hsize_t>{rows, components};
}

/// A dataset `name` of `dims` whose values are the `selection` of dataset `place` of another file.
void write_view(OutputFile& file, const std::string& name, hid_t type, const std::vector<hsize_t>& dims,
                const std::string& source, const std::string& place, const Handle& selection) {
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  file.check(H5Pset_virtual(creation.id(), space.id(), source.c_str(), place.c_str(), selection.id()), "create");
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  const Handle view(H5Dcreate2(file.id(), name.c_str(), type, space.id(), links.id(), creation.id(), H5P_DEFAULT),
                    H5Dclose);
  file.check(view.id(), "create");
}

void write_field_view(OutputFile& file, const std::string& source, const ViewedField& field, std::uint64_t step) {
  const auto dims = dims_of(field.n_rows, field.n_components);
  const auto stored = dims_of(field.n_stored, field.n_components);
  const Handle selection(H5Screate_simple(static_cast<int>(stored.size()), stored.data(), nullptr), H5Sclose);
  const hsize_t start[2] = {step * field.n_rows, 0};
  file.check(H5Sselect_hyperslab(selection.id(), H5S_SELECT_SET, start, nullptr, dims.data(), nullptr), "create");
  write_view(file, view_name(field, step), H5T_IEEE_F32LE, dims, source, field.dataset(), selection);
}

void write_topology(OutputFile& file, const std::string& source, const ViewedTopology& topology) {
  if (!topology.mixed.empty()) {
    file.write_static("/Topology", H5T_STD_I64LE, H5T_NATIVE_INT64, {topology.mixed.size()}, topology.mixed.data());
    return;
  }
  const hsize_t length = topology.n_cells * topology.n_nodes;
  const Handle whole(H5Screate_simple(1, &length, nullptr), H5Sclose);
  write_view(file, "/Topology", H5T_STD_I64LE, {topology.n_cells, topology.n_nodes}, source, "/VTKHDF/Connectivity",
             whole);
}

}  // namespace

std::string view_name(const ViewedField& field, std::uint64_t step) {
  return "/step_" + std::to_string(step) + (field.of_points ? "/points/" : "/cells/") + field.name;
}

void write_views(const std::string& path, const std::string& source, const std::vector<ViewedField>& fields,
                 std::uint64_t n_steps, const ViewedTopology& topology) {
  OutputFile file(path, {});
  for (std::uint64_t step = 0; step < n_steps; ++step) {
    for (const ViewedField& field : fields) {
      if (!field.is_static) write_field_view(file, source, field, step);
    }
  }
  write_topology(file, source, topology);
  file.close();
}

}  // namespace proto::hdf5
