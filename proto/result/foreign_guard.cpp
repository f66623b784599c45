#include "proto/result/foreign_guard.hpp"

#include <vector>

namespace proto::hdf5 {
namespace {

constexpr hsize_t harmless = 1 << 20;  // values that anybody may claim
constexpr hsize_t most_values = hsize_t{1} << 40;
constexpr hsize_t largest_ratio = 1032;  // of deflate

std::string source_of(hid_t properties, std::size_t i) {
  const auto length = H5Pget_virtual_filename(properties, i, nullptr, 0);
  std::vector<char> name(length > 0 ? static_cast<std::size_t>(length) + 1 : 1);
  H5Pget_virtual_filename(properties, i, name.data(), name.size());
  return name.data();
}

Handle properties_of(hid_t dataset) {
  return {H5Dget_create_plist(dataset), H5Pclose};
}

}  // namespace

bool lies_within(hid_t file, const std::string& object) {
  for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {
    const std::string part = object.substr(0, end);
    H5L_info_t link{};
    if (part != "/" && (H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0 ||
                        H5Lget_info(file, part.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD))
      return false;
    if (end == std::string::npos) return true;
  }
}

std::string why_not_read(hid_t dataset) {
  const auto properties = properties_of(dataset);
  if (H5Pget_external_count(properties.id()) != 0) return "its values lie in another file";
  if (H5Pget_layout(properties.id()) != H5D_VIRTUAL) return {};
  std::size_t n = 0;
  if (H5Pget_virtual_count(properties.id(), &n) < 0) return "its sources are not named";
  for (std::size_t i = 0; i < n; ++i)
    if (source_of(properties.id(), i).find('/') != std::string::npos) return "it shows a file of another folder";
  return {};
}

std::string why_too_large(hid_t dataset, hsize_t n) {
  if (n <= harmless) return {};
  if (n > most_values) return "it claims more values than any memory holds";
  if (H5Pget_layout(properties_of(dataset).id()) == H5D_VIRTUAL) return {};
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const hsize_t bytes = n * H5Tget_size(type.id());
  // The file's size, not the dataset's own: of a writer that was killed the index may be torn behind the committed
  // rows, and HDF5 then knows no size of the dataset.
  const Handle file(H5Iget_file_id(dataset), H5Fclose);
  hsize_t file_bytes = 0;
  if (H5Fget_filesize(file.id(), &file_bytes) < 0) return "the file has no size";
  return bytes / largest_ratio > file_bytes ? "it claims more values than the file can hold" : "";
}

}  // namespace proto::hdf5
