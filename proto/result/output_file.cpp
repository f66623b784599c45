#include "proto/result/output_file.hpp"

#include <endian.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace proto::hdf5 {
namespace {

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

std::vector<hsize_t> with_rows(hsize_t rows, const std::vector<hsize_t>& row_shape) {
  std::vector<hsize_t> dims{rows};
  dims.insert(dims.end(), row_shape.begin(), row_shape.end());
  return dims;
}

}  // namespace

OutputFile::OutputFile(const std::string& path, const Attributes& attributes) : path_(path) {
  start_library();
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // No lock: a running simulation's file can be looked at, and a stale lock of a killed one cannot be in the way.
  H5Pset_file_locking(access.id(), false, true);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  // A write that SIGKILL interrupts may stop at a page's end: an index node within one page is old or new, never both.
  H5Pset_alignment(access.id(), 512, 4096);
  Handle creation = timeless(H5P_FILE_CREATE);
  file_ = Handle(check(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), "create"), H5Fclose);
  for (const auto& [name, value] : attributes) write_attribute(file_.id(), name, value);
}

OutputFile::~OutputFile() {
  for (auto& handle : kept_) {
    if (!broken_ && !handle.close()) broken_ = true;
    handle.abandon();
  }
  if (broken_) {
    file_.abandon();
  } else if (file_ && file_.close()) {
    give_back_blocks();
  }
}

hid_t OutputFile::create_group(const std::string& name) {
  const Handle links = with_groups();
  const Handle creation = timeless(H5P_GROUP_CREATE);
  return keep({H5Gcreate2(file_.id(), name.c_str(), links.id(), creation.id(), H5P_DEFAULT), H5Gclose}, "create");
}

hid_t OutputFile::create_dataset(const DatasetSpec& spec) {
  const Handle links = with_groups();
  const Handle creation = timeless(H5P_DATASET_CREATE);
  const auto dims = with_rows(0, spec.row_shape);
  const auto largest = with_rows(H5S_UNLIMITED, spec.row_shape);
  const auto chunk = with_rows(spec.chunk_rows, spec.row_shape);
  const int rank = static_cast<int>(dims.size());
  check(H5Pset_chunk(creation.id(), rank, chunk.data()), "create");
  const Handle space(H5Screate_simple(rank, dims.data(), largest.data()), H5Sclose);
  const hid_t dataset =
      keep({H5Dcreate2(file_.id(), spec.name.c_str(), spec.type, space.id(), links.id(), creation.id(), H5P_DEFAULT),
            H5Dclose},
           "create");
  if (!spec.unit.empty()) write_attribute(dataset, "units", spec.unit);
  if (!spec.description.empty()) write_attribute(dataset, "description", spec.description);
  return dataset;
}

void OutputFile::write_static(const std::string& name, hid_t file_type, hid_t memory_type,
                              const std::vector<hsize_t>& dims, const void* values, const std::string& unit,
                              const std::string& description) {
  const Handle links = with_groups();
  const Handle creation = timeless(H5P_DATASET_CREATE);
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  Handle dataset(H5Dcreate2(file_.id(), name.c_str(), file_type, space.id(), links.id(), creation.id(), H5P_DEFAULT),
                 H5Dclose);
  check(dataset.id(), "create");
  hsize_t count = 1;
  for (const hsize_t extent : dims) count *= extent;
  if (count > 0) check(H5Dwrite(dataset.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write");
  if (!unit.empty()) write_attribute(dataset.id(), "units", unit);
  if (!description.empty()) write_attribute(dataset.id(), "description", description);
  if (!dataset.close()) fail("write", last_error());
}

void OutputFile::write_attribute(hid_t object, const std::string& name, const Attribute& value) {
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const auto put = [&](hid_t file_type, hid_t memory_type, const void* data) {
    const Handle attribute(H5Acreate2(object, name.c_str(), file_type, scalar.id(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    check(attribute.id(), "create");
    check(H5Awrite(attribute.id(), memory_type, data), "write");
  };
  if (const auto* number = std::get_if<double>(&value)) return put(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return put(H5T_STD_I64LE, H5T_NATIVE_INT64, whole);
  const Handle type = text_type();
  const char* text = std::get<std::string>(value).c_str();
  put(type.id(), type.id(), &text);
}

hid_t OutputFile::create_counter(hid_t object, const std::string& name) {
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const hid_t counter = keep(
      {H5Acreate2(object, name.c_str(), H5T_STD_I64LE, scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose}, "create");
  set_counter(counter, 0);
  return counter;
}

void OutputFile::seal() {
  flush();
  code_ = ExitCode::io_error;
}

void OutputFile::append_rows(hid_t dataset, hid_t memory_type, const std::vector<hsize_t>& row_shape, hsize_t first_row,
                             hsize_t n_rows, const void* values) {
  const auto extent = with_rows(first_row + n_rows, row_shape);
  check(H5Dset_extent(dataset, extent.data()), "extend");
  const auto count = with_rows(n_rows, row_shape);
  std::vector<hsize_t> start(count.size(), 0);
  start[0] = first_row;
  const Handle target(H5Dget_space(dataset), H5Sclose);
  check(H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), "write");
  const Handle source(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
  check(H5Dwrite(dataset, memory_type, source.id(), target.id(), H5P_DEFAULT, values), "write");
}

void OutputFile::set_counter(hid_t counter, std::int64_t value) {
  check(H5Awrite(counter, H5T_NATIVE_INT64, &value), "write");
}

void OutputFile::flush() {
  announce_end();
  check(H5Fflush(file_.id(), H5F_SCOPE_LOCAL), "write");
}

// HDF5 writes its superblock, and in it the end of the file, after the index nodes that may lie behind the old end: a kill
// between them would leave committed rows that cannot be reached. The format of the oldest superblock is fixed.
void OutputFile::announce_end() {
  constexpr off_t version_at = 8, end_at = 40;
  haddr_t end = 0;
  check(H5Fget_eoa(file_.id(), &end), "write");
  const int file = descriptor();
  struct stat status {};
  std::uint8_t version = 1;
  if (::pread(file, &version, 1, version_at) != 1 || version != 0) return;  // nothing was flushed yet
  const bool grown = ::fstat(file, &status) == 0 &&
                     (static_cast<haddr_t>(status.st_size) >= end || ::ftruncate(file, static_cast<off_t>(end)) == 0);
  const std::uint64_t little_endian = htole64(end);
  if (!grown || ::pwrite(file, &little_endian, sizeof little_endian, end_at) != sizeof little_endian)
    fail("write", std::strerror(errno));
}

void OutputFile::rename_to(const std::string& path) {
  if (::rename(path_.c_str(), path.c_str()) != 0) fail("rename", std::strerror(errno));
  path_ = path;
}

void OutputFile::synchronise() const {
  if (::fsync(descriptor()) != 0) fail("write", std::strerror(errno));
}

void OutputFile::close() {
  refuse_if_broken();
  broken_ = true;
  for (auto& handle : kept_) {
    if (!handle.close()) fail("write", last_error());
  }
  if (!file_.close()) fail("close", last_error());
  give_back_blocks();
  broken_ = false;
}

void OutputFile::give_back_blocks() const {
  struct stat status {};
  if (::stat(path_.c_str(), &status) == 0) static_cast<void>(::truncate(path_.c_str(), status.st_size));
}

void OutputFile::fail(const std::string& action, const std::string& reason) const {
  const bool creating = code_ == ExitCode::cannot_create;
  throw Error(
      code_, "cannot " + action + " the result file (" + reason + ")", path_,
      creating ? "choose another --out, or free space" : "free space; what was committed before is in the file");
}

void OutputFile::refuse_if_broken() const {
  if (!broken_ && file_) return;
  throw Error(code_, file_ ? "an earlier write failed" : "the result file is closed", path_,
              "nothing more is written to it");
}

void OutputFile::reserve(std::uint64_t bytes) {
  constexpr std::uint64_t metadata_bytes = 256 * 1024;  // more than the index of one commit takes
  constexpr std::uint64_t slice_bytes = 4 * 1024 * 1024;
  haddr_t end = 0;
  check(H5Fget_eoa(file_.id(), &end), "write");
  const std::uint64_t wanted = end + bytes + metadata_bytes;
  if (wanted <= reserved_end_) return;
  // The file keeps its length; the blocks behind its end are given back by close().
  const auto set_aside = [&](std::uint64_t to) {
    return ::fallocate(descriptor(), FALLOC_FL_KEEP_SIZE, static_cast<off_t>(end), static_cast<off_t>(to - end)) == 0;
  };
  if (set_aside(wanted + slice_bytes)) {
    reserved_end_ = wanted + slice_bytes;
  } else if (set_aside(wanted)) {
    reserved_end_ = wanted;
  } else if (errno == ENOSPC || errno == EDQUOT) {
    fail("write", std::strerror(errno));
  }  // else a file system without reservation: the write itself will tell
}

int OutputFile::descriptor() const {
  int* number = nullptr;
  check(H5Fget_vfd_handle(file_.id(), H5P_DEFAULT, reinterpret_cast<void**>(&number)), "write");
  return *number;
}

hid_t OutputFile::keep(Handle handle, const char* action) {
  check(handle.id(), action);
  kept_.push_back(std::move(handle));
  return kept_.back().id();
}

}  // namespace proto::hdf5
