#include "proto/result/views_file.hpp"

#include "proto/result/output_file.hpp"

namespace proto::hdf5 {
namespace {

std::vector<hsize_t> dims_of(hsize_t rows, hsize_t components) {
  return components == 1 ? std::vector<hsize_t>{rows} : std::vector<hsize_t>{rows, components};
}

void write_view(OutputFile& file, const std::string& source, const ViewedField& field, std::uint64_t step) {
  const auto view_dims = dims_of(field.n_rows, field.n_components);
  const auto source_dims = dims_of(field.n_stored, field.n_components);
  const int rank = static_cast<int>(view_dims.size());
  const Handle view_space(H5Screate_simple(rank, view_dims.data(), nullptr), H5Sclose);
  const Handle source_space(H5Screate_simple(rank, source_dims.data(), nullptr), H5Sclose);
  const hsize_t start[2] = {step * field.n_rows, 0};
  file.check(H5Sselect_hyperslab(source_space.id(), H5S_SELECT_SET, start, nullptr, view_dims.data(), nullptr),
             "create");
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  file.check(H5Pset_virtual(creation.id(), view_space.id(), source.c_str(), field.dataset().c_str(), source_space.id()),
             "create");
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  const Handle view(H5Dcreate2(file.id(), view_name(field, step).c_str(), H5T_IEEE_F32LE, view_space.id(), links.id(),
                               creation.id(), H5P_DEFAULT),
                    H5Dclose);
  file.check(view.id(), "create");
}

}  // namespace

std::string view_name(const ViewedField& field, std::uint64_t step) {
  return "/step_" + std::to_string(step) + (field.of_points ? "/points/" : "/cells/") + field.name;
}

void write_views(const std::string& path, const std::string& source, const std::vector<ViewedField>& fields,
                 std::uint64_t n_steps, const std::vector<std::int64_t>& topology) {
  OutputFile file(path, {});
  for (std::uint64_t step = 0; step < n_steps; ++step) {
    for (const ViewedField& field : fields) {
      if (!field.is_static) write_view(file, source, field, step);
    }
  }
  if (!topology.empty()) {
    file.write_static("/Topology", H5T_STD_I64LE, H5T_NATIVE_INT64, {topology.size()}, topology.data());
  }
  file.close();
}

}  // namespace proto::hdf5
