// Tests that hold for a rail of any kind, run with both.
#pragma once

#include <gtest/gtest.h>

#include <ostream>

#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/rail/solid_rail.hpp"

namespace tests {

struct NamedRail {
  const char* name;
  fem::RailBuilder build;
  friend void PrintTo(const NamedRail& rail, std::ostream* out) { *out << rail.name; }
};

class BothRails : public ::testing::TestWithParam<NamedRail> {
 public:
  static auto kinds() {
    return ::testing::Values(NamedRail{"solid", fem::build_solid_rail}, NamedRail{"beam", fem::build_beam_rail});
  }
  static std::string name(const ::testing::TestParamInfo<NamedRail>& info) { return info.param.name; }
};

}  // namespace tests
