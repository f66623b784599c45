#include "proto/result/state_file.hpp"

#include <xxhash.h>

#include <atomic>
#include <fstream>
#include <sstream>

#include "proto/error.hpp"
#include "proto/result/hdf5_handle.hpp"
#include "proto/result/text_file.hpp"

namespace proto {
namespace {

using hdf5::Handle;

constexpr std::size_t memory_step = 1 << 20;  // by which the file in memory grows [bytes]
constexpr hsize_t largest_chunk = 1 << 20;    // values under one checksum

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ExitCode::missing_input, "no such checkpoint file", path);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (file.bad()) throw Error(ExitCode::io_error, "cannot read the checkpoint file", path);
  return std::move(bytes).str();
}

std::uint64_t hash_of(const std::string& bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

// The oldest format, HDF5's own choice: of later ones the image of an open file does not open again (1.10.8: its flag
// "being written" is cleared, the superblock's checksum is not).
Handle memory_access() {
  hdf5::start_library();
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), memory_step, false);
  return access;
}

/// HDF5 tells open files apart by name, also those in memory.
std::string new_name() {
  static std::atomic<int> count{0};
  return "checkpoint-" + std::to_string(++count);
}

Handle checked_layout(hsize_t n) {
  Handle creation = hdf5::timeless(H5P_DATASET_CREATE);
  if (n == 0) return creation;
  const hsize_t chunk = std::min(n, largest_chunk);
  H5Pset_chunk(creation.id(), 1, &chunk);
  H5Pset_fletcher32(creation.id());
  return creation;
}

}  // namespace

struct StateWriter::Data {
  Data() {
    const Handle access = memory_access(), creation = hdf5::timeless(H5P_FILE_CREATE);
    file = Handle(H5Fcreate(new_name().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
    check(file.id());
  }

  void put(const std::string& name, hid_t file_type, hid_t memory_type, hsize_t n, const void* values) const {
    const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose), links = hdf5::with_groups();
    const Handle layout = checked_layout(n);
    const Handle dataset(
        H5Dcreate2(file.id(), name.c_str(), file_type, space.id(), links.id(), layout.id(), H5P_DEFAULT), H5Dclose);
    check(dataset.id());
    if (n > 0) check(H5Dwrite(dataset.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  }

  template <class Status>
  Status check(Status status) const {
    if (status < 0) throw Error(ExitCode::internal, "cannot gather the state (" + hdf5::last_error() + ")");
    return status;
  }

  Handle file;
};

StateWriter::StateWriter() : data_(std::make_unique<Data>()) {}
StateWriter::~StateWriter() = default;

void StateWriter::operator()(const std::string& name, std::vector<double>& values) {
  data_->put(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.size(), values.data());
}

void StateWriter::operator()(const std::string& name, std::vector<std::int64_t>& values) {
  data_->put(name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.size(), values.data());
}

void StateWriter::refuse(const std::string& name, const std::string& problem) const {
  throw Error(ExitCode::internal, "a state that cannot be saved: " + problem, name);
}

std::string StateWriter::image() {
  data_->check(H5Fflush(data_->file.id(), H5F_SCOPE_LOCAL));
  const auto size = data_->check(H5Fget_file_image(data_->file.id(), nullptr, 0));
  std::string bytes(static_cast<std::size_t>(size), '\0');
  data_->check(H5Fget_file_image(data_->file.id(), bytes.data(), bytes.size()));
  return bytes;
}

std::uint64_t StateWriter::write(const std::string& path) {
  const std::string bytes = image();
  write_text_file(path, bytes);
  return hash_of(bytes);
}

std::uint64_t StateWriter::hash() {
  return hash_of(image());
}

struct StateReader::Data {
  std::string path, bytes;
  Handle file;
};

StateReader::StateReader(const std::string& path, std::uint64_t hash) : data_(std::make_unique<Data>()) {
  data_->path = path;
  data_->bytes = content_of(path);
  if (hash_of(data_->bytes) != hash)
    throw Error(ExitCode::bad_data, "the checkpoint file is damaged: its content has another hash", path);
  const Handle access = memory_access();
  H5Pset_file_image(access.id(), data_->bytes.data(), data_->bytes.size());
  data_->file = Handle(H5Fopen(new_name().c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!data_->file) throw Error(ExitCode::bad_data, "not a checkpoint (" + hdf5::last_error() + ")", path);
  data_->bytes = {};
}

StateReader::~StateReader() = default;

void StateReader::refuse(const std::string& name, const std::string& problem) const {
  throw Error(ExitCode::bad_data, "the checkpoint does not fit: " + problem, data_->path + ":" + name);
}

namespace {

/// Reads a dataset of one dimension into `values`; false when it is not there or cannot be read.
template <class Value>
bool read_list(hid_t file, const std::string& name, hid_t memory_type, std::vector<Value>& values) {
  const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) return false;
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
  return values.empty() || H5Dread(dataset.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
}

}  // namespace

void StateReader::operator()(const std::string& name, std::vector<double>& values) {
  if (!read_list(data_->file.id(), name, H5T_NATIVE_DOUBLE, values)) refuse(name, hdf5::last_error());
}

void StateReader::operator()(const std::string& name, std::vector<std::int64_t>& values) {
  if (!read_list(data_->file.id(), name, H5T_NATIVE_INT64, values)) refuse(name, hdf5::last_error());
}

std::uint64_t hash_of_file(const std::string& path) {
  return hash_of(content_of(path));
}

}  // namespace proto
