#include "qdem_solver/output/hdf5_store.hpp"

#include <sstream>

#include "proto/error.hpp"

namespace qdem {
namespace {

/// Closes an HDF5 object at the end of its scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace

Hdf5Store Hdf5Store::create(const std::string& path) {
  silence();
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0) {
    throw proto::Error(proto::ExitCode::cannot_create, "the file cannot be created", path, "check the folder's rights");
  }
  return {path, file, true};
}

Hdf5Store Hdf5Store::open(const std::string& path) {
  silence();
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw proto::Error(proto::ExitCode::bad_data, "not an HDF5 file", path, "delete it");
  return {path, file, false};
}

Hdf5Store::~Hdf5Store() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Store::close() {
  const bool written = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(file_) >= 0;
  file_ = -1;
  if (!written || !closed) fail("/");
}

void Hdf5Store::fail(const std::string& name) const {
  const auto code = writing_ ? proto::ExitCode::io_error : proto::ExitCode::bad_data;
  throw proto::Error(code, writing_ ? "data cannot be written (disk full?)" : "data is missing or damaged",
                     path_ + ":" + name, writing_ ? "free some space" : "delete the file; it will be built again");
}

void Hdf5Store::put_raw(const std::string& name, hid_t type, const void* values, std::size_t n,
                        const std::string& units) {
  const hsize_t size = n;
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Handle set(H5Dcreate2(file_, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (set < 0 || (n > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)) fail(name);
  if (units.empty()) return;
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(text, units.size());
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(set, "units", text, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute < 0 || H5Awrite(attribute, text, units.data()) < 0) fail(name);
}

void Hdf5Store::put(const std::string& name, const std::vector<double>& values, const std::string& units) {
  put_raw(name, H5T_NATIVE_DOUBLE, values.data(), values.size(), units);
}

void Hdf5Store::put(const std::string& name, const std::vector<long long>& values) {
  put_raw(name, H5T_NATIVE_LLONG, values.data(), values.size(), {});
}

void Hdf5Store::put(const std::string& name, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  put_raw(name, H5T_NATIVE_CHAR, text.data(), text.size(), {});
}

std::size_t Hdf5Store::size(const std::string& name) const {
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0) fail(name);
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (n < 0) fail(name);
  return static_cast<std::size_t>(n);
}

void Hdf5Store::get_raw(const std::string& name, hid_t type, void* values) const {
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0 || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) fail(name);
}

std::vector<double> Hdf5Store::reals(const std::string& name) const {
  std::vector<double> values(size(name));
  if (!values.empty()) get_raw(name, H5T_NATIVE_DOUBLE, values.data());
  return values;
}

std::vector<long long> Hdf5Store::integers(const std::string& name) const {
  std::vector<long long> values(size(name));
  if (!values.empty()) get_raw(name, H5T_NATIVE_LLONG, values.data());
  return values;
}

std::vector<std::string> Hdf5Store::lines(const std::string& name) const {
  std::string text(size(name), '\0');
  if (!text.empty()) get_raw(name, H5T_NATIVE_CHAR, text.data());
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

}  // namespace qdem
