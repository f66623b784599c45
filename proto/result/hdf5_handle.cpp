#include "proto/result/hdf5_handle.hpp"

namespace proto::hdf5 {
namespace {

herr_t take_innermost(unsigned, const H5E_error2_t* error, void* text) {
  auto& found = *static_cast<std::string*>(text);
  if (found.empty() && error->desc != nullptr) found = error->desc;
  return 0;
}

}  // namespace

void start_library() {
  static const bool started = [] {
    H5dont_atexit();
    H5open();
    H5PLset_loading_state(0);  // a file may name a filter, and HDF5 would run it from any folder of its path
    return H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  }();
  static_cast<void>(started);
}

std::string last_error() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_innermost, &text);
  // The file driver writes "... errno = 28, error message = 'No space left on device', ...".
  const std::string key = "error message = '";
  const auto begin = text.find(key);
  if (begin == std::string::npos) return text.empty() ? "HDF5 gives no reason" : text;
  const auto end = text.find('\'', begin + key.size());
  return text.substr(begin + key.size(), end - begin - key.size());
}

Handle timeless(hid_t property_class) {
  Handle properties(H5Pcreate(property_class), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  return properties;
}

Handle with_groups() {
  Handle properties(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(properties.id(), 1);
  return properties;
}

}  // namespace proto::hdf5
