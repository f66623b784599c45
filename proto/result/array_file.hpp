// Arrays that are known whole, written at once: results of an analysis.
#pragma once

#include <string>
#include <vector>

#include "proto/result/attributes.hpp"

namespace proto {

struct NamedArray {
  std::string name;  ///< may contain groups: "transfer/frequency"
  std::string unit;  ///< "Hz", "1" for a pure number
  std::string description;
  std::vector<double> values;
};

/// Writes (or replaces) the HDF5 file `path` with one float64 dataset per array, `units` and `description` as its
/// attributes, and `attributes` on the root. The content depends on nothing but the values given.
/// Throws proto::Error: cannot_create, io_error with path and reason.
void write_array_file(const std::string& path, const std::vector<NamedArray>& arrays, const Attributes& attributes);

}  // namespace proto
