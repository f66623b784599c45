// One number for all that crossed the interface: equal runs have it equal.
#pragma once

#include <cstdint>
#include <string>

#include "coupler/scheme/window_record.hpp"

namespace coupler {

/// Chain of XXH3-64 over window numbers, sub-cycles and every interface value of every window, in their order; wall
/// times do not enter.
class InterfaceHash {
 public:
  void add(const WindowRecord& record);
  std::uint64_t value() const { return value_; }
  void set(std::uint64_t value) { value_ = value; }

 private:
  std::uint64_t value_ = 0;
};

}  // namespace coupler
