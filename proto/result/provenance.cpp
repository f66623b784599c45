#include "proto/result/provenance.hpp"

#include <array>
#include <cstdio>

#include "proto/result/hdf5_handle.hpp"

namespace proto {
namespace {

std::string hexadecimal(std::uint64_t value) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
  return text.data();
}

std::string hdf5_version() {
  hdf5::start_library();
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

}  // namespace

std::string project_version() {
  return HOUSE_VERSION;
}
std::string source_description() {
  return HOUSE_SOURCE;
}

Attributes provenance(const std::string& program, const std::string& case_name, std::uint64_t case_hash,
                      const std::string& case_text) {
  return {{"program", program},
          {"version", project_version()},
          {"source", source_description()},
          {"hdf5_version", hdf5_version()},
          {"compiler", std::string(__VERSION__)},
          {"case_name", case_name},
          {"case_hash", hexadecimal(case_hash)},
          {"case_text", case_text}};
}

}  // namespace proto
