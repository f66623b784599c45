#include "proto/result/reader.hpp"

#include <algorithm>
#include <filesystem>

#include "proto/error.hpp"
#include "proto/result/foreign_guard.hpp"
#include "proto/result/hdf5_handle.hpp"

namespace proto {
namespace {

using hdf5::Handle;

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

Handle open_file(const std::string& path) {
  hdf5::start_library();
  if (!std::filesystem::exists(path)) throw Error(ExitCode::missing_input, "no such result file", path);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // As HDF5 1.10 itself opens the source of a virtual dataset: with another way of locking or closing, a view of a file
  // that this process has open reads as zeros.
  H5Pset_file_locking(access.id(), true, true);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_WEAK);
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file) throw Error(ExitCode::bad_data, "not a readable HDF5 file (" + hdf5::last_error() + ")", path);
  return file;
}

std::vector<hsize_t> extents(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(0, rank)));
  H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr);
  return dims;
}

}  // namespace

struct ResultReader::Data {
  explicit Data(const std::string& name) : path(name), file(open_file(name)) {}

  [[noreturn]] void fail(const std::string& problem, const std::string& object) const {
    throw Error(ExitCode::bad_data, problem + " \"" + object + "\" in the result file", path);
  }
  void require_within(const std::string& object) const {
    if (!hdf5::lies_within(file.id(), object)) fail("no object, or a link to somewhere else,", object);
  }
  Handle attribute(const std::string& object, const std::string& name) const {
    require_within(object);
    Handle found(H5Aopen_by_name(file.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!found) fail("no attribute", object + "@" + name);
    return found;
  }
  Handle dataset(const std::string& name) const {
    require_within(name);
    Handle found(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!found) fail("no dataset", name);
    if (const auto why = hdf5::why_not_read(found.id()); !why.empty()) fail(why + ": dataset", name);
    return found;
  }

  std::string path;
  Handle file;
};

ResultReader::ResultReader(const std::string& path) : data_(std::make_unique<Data>(path)) {}
ResultReader::ResultReader(ResultReader&&) noexcept = default;
ResultReader::~ResultReader() = default;

bool ResultReader::has(const std::string& object) const {
  return hdf5::lies_within(data_->file.id(), object);
}

std::uint64_t ResultReader::n_committed(const std::string& group) const {
  return static_cast<std::uint64_t>(number(group, "n_committed"));
}

std::uint64_t ResultReader::n_steps() const {
  return has("/VTKHDF/Steps") ? static_cast<std::uint64_t>(number("/VTKHDF/Steps", "NSteps")) : 0;
}

std::vector<std::size_t> ResultReader::shape(const std::string& dataset) const {
  const auto dims = extents(data_->dataset(dataset).id());
  return {dims.begin(), dims.end()};
}

bool ResultReader::is_extendable(const std::string& dataset) const {
  const Handle source = data_->dataset(dataset);
  const Handle creation(H5Dget_create_plist(source.id()), H5Pclose);
  return H5Pget_layout(creation.id()) == H5D_CHUNKED;
}

ResultArray ResultReader::read(const std::string& dataset) const {
  const auto dims = extents(data_->dataset(dataset).id());
  return read_rows(dataset, dims.empty() ? 1 : dims[0]);
}

ResultArray ResultReader::read_rows(const std::string& dataset, std::uint64_t n_rows) const {
  return read_rows(dataset, 0, n_rows);
}

ResultArray ResultReader::read_rows(const std::string& dataset, std::uint64_t first, std::uint64_t n_rows) const {
  const Handle source = data_->dataset(dataset);
  auto dims = extents(source.id());
  if (!dims.empty()) {
    if (n_rows > dims[0] || first > dims[0] - n_rows) data_->fail("fewer rows than committed: dataset", dataset);
    dims[0] = n_rows;
  }
  hsize_t n_values = 1;
  for (const hsize_t extent : dims)
    if (__builtin_mul_overflow(n_values, extent, &n_values)) data_->fail("no memory holds the dataset", dataset);
  if (const auto why = hdf5::why_too_large(source.id(), n_values); !why.empty())
    data_->fail(why + ": dataset", dataset);
  ResultArray array{{dims.begin(), dims.end()}, {}};
  array.values.resize(n_values);
  if (array.values.empty()) return array;
  const Handle target(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Handle selected(H5Dget_space(source.id()), H5Sclose);
  std::vector<hsize_t> start(dims.size(), 0);
  if (!dims.empty()) {
    start[0] = first;
    H5Sselect_hyperslab(selected.id(), H5S_SELECT_SET, start.data(), nullptr, dims.data(), nullptr);
  }
  if (H5Dread(source.id(), H5T_NATIVE_DOUBLE, target.id(), selected.id(), H5P_DEFAULT, array.values.data()) < 0) {
    data_->fail("cannot read (" + hdf5::last_error() + ") dataset", dataset);
  }
  return array;
}

bool ResultReader::has_attribute(const std::string& object, const std::string& attribute) const {
  return H5Aexists_by_name(data_->file.id(), object.c_str(), attribute.c_str(), H5P_DEFAULT) > 0;
}

double ResultReader::number(const std::string& object, const std::string& attribute) const {
  const Handle source = data_->attribute(object, attribute);
  double value = 0.0;
  if (H5Aread(source.id(), H5T_NATIVE_DOUBLE, &value) < 0) data_->fail("no number", object + "@" + attribute);
  return value;
}

std::string ResultReader::text(const std::string& object, const std::string& attribute) const {
  const Handle source = data_->attribute(object, attribute);
  const Handle type(H5Aget_type(source.id()), H5Tclose);
  if (H5Tis_variable_str(type.id()) <= 0) data_->fail("no text", object + "@" + attribute);
  char* text = nullptr;
  if (H5Aread(source.id(), type.id(), &text) < 0) data_->fail("cannot read", object + "@" + attribute);
  std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

std::vector<std::string> ResultReader::members(const std::string& group) const {
  data_->require_within(group);
  const Handle source(H5Gopen2(data_->file.id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!source) data_->fail("no group", group);
  std::vector<std::string> names;
  H5Literate(source.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_name, &names);
  return names;
}

}  // namespace proto
