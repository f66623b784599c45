// What a file from somebody else must not do to its reader. Internal to this folder.
#pragma once

#include <hdf5.h>

#include <string>

#include "proto/result/hdf5_handle.hpp"

namespace proto::hdf5 {

/// Whether the object lies in this file: every link on the way to it is a hard one. A soft or external link may lead
/// anywhere, a file of another user included.
bool lies_within(hid_t file, const std::string& object);

/// Why the values of a dataset are not read; "" when nothing speaks against it. They must lie in this file: HDF5 would
/// read any file on the machine that "external storage" or a virtual dataset names. Only our own views are let through,
/// whose sources are files of the same folder, named without one.
std::string why_not_read(hid_t dataset);

/// Why memory is not reserved for `n` values of a dataset; "" when nothing speaks against it. A file of some kilobytes
/// can claim any size; more than deflate's largest ratio (1032) over the file's size is not believed, nor more values
/// than 2^40.
std::string why_too_large(hid_t dataset, hsize_t n);

}  // namespace proto::hdf5
