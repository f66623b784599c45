#include "proto/result/array_file.hpp"

#include "proto/result/output_file.hpp"

namespace proto {

void write_array_file(const std::string& path, const std::vector<NamedArray>& arrays, const Attributes& attributes) {
  hdf5::OutputFile file(path, attributes);
  for (const NamedArray& array : arrays) {
    file.write_static("/" + array.name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {array.values.size()}, array.values.data(),
                      array.unit, array.description);
  }
  file.seal();
  file.close();
}

}  // namespace proto
