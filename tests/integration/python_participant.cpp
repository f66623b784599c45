// The rail's side as a program in another language, written from proto/README.md: it couples like the one in C++.
#include <cmath>
#include <cstdlib>

#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/tolerance.hpp"

namespace {

const std::string script = HOUSE_BIN_DIR "/../test_bin/spring_rail/spring_rail.py";

bool can_run() {
  return std::system("/usr/bin/python3 -c 'import flatbuffers, xxhash, zmq' 2>/dev/null") == 0;
}

tests::OscillatorCase with_python(tests::OscillatorCase variant) {
  variant.fem_command = "[\"" + script + "\", \"participant\"]";
  return variant;
}

class PythonRail : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_run()) GTEST_SKIP() << "NOT RUN: /usr/bin/python3 lacks flatbuffers, xxhash or zmq";
  }

  static nlohmann::json run(const std::string& text) {
    tests::CoupledRun coupled(text);
    EXPECT_EQ(coupled.run().value_or(-1), 0) << coupled.message();
    auto summary = coupled.summary();
    EXPECT_EQ(summary.value("status", ""), "ok");
    return summary;
  }

  static void expect_equal_ends(const std::string& in_cpp, const std::string& in_python) {
    const auto target = run(in_cpp).at("oscillator"), found = run(in_python).at("oscillator");
    for (const char* side : {"implicit", "explicit"})
      for (const char* quantity : {"x", "v", "time_s"})
        EXPECT_TRUE(tests::near_rel(found[side][quantity], target[side][quantity], 1e-12)) << side << ' ' << quantity;
  }
};

class Scheme : public PythonRail, public ::testing::WithParamInterface<const char*> {};

TEST_P(Scheme, CouplesLikeTheOneInCpp) {
  tests::OscillatorCase variant;
  variant.scheme = GetParam();
  expect_equal_ends(variant.text(), with_python(variant).text());
}

TEST_P(Scheme, LetsThePadGo) {
  tests::OscillatorCase variant;
  variant.scheme = GetParam();
  const auto loose = [](std::string text) {
    return text.insert(text.find("damping_ns_per_m = "), "tension_cutoff = true\nclip_preload_n = 2.0\n");
  };
  const auto tied = run(variant.text()).at("oscillator").at("implicit").at("x").get<double>();
  const auto free = run(loose(variant.text())).at("oscillator").at("implicit").at("x").get<double>();
  EXPECT_GT(std::abs(tied - free), 1e-2) << "the cut-off does nothing in this case";
  expect_equal_ends(loose(variant.text()), loose(with_python(variant).text()));
}
INSTANTIATE_TEST_SUITE_P(all, Scheme, ::testing::Values("R1", "R2", "E1"));

TEST_F(PythonRail, ChecksItsSection) {
  tests::CoupledRun good(with_python({}).text());
  EXPECT_EQ(good.run({"check", good.case_path()}).value_or(-1), 0) << good.message();
  auto text = with_python({}).text();
  text.replace(text.find("mass_kg"), 7, "mass_g");
  tests::CoupledRun bad(text);
  const int status = std::system((script + " check --case " + bad.case_path() + " 2>/dev/null").c_str());
  EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(proto::ExitCode::config));
}

TEST_F(PythonRail, NotANumberIsItsFault) {
  auto variant = with_python({});
  variant.initial_displacement_m = 1e308;
  tests::CoupledRun coupled(variant.text());
  EXPECT_EQ(coupled.run().value_or(-1), static_cast<int>(proto::ExitCode::numerics)) << coupled.message();
  EXPECT_TRUE(tests::contains(coupled.message(), "not finite")) << coupled.message();
}

}  // namespace
