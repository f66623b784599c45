// `[qdem]`: what is accepted, and what is refused with which words.
#include "qdem_solver/participant/qdem_case.hpp"

#include <gtest/gtest.h>

#include "proto/error.hpp"
#include "tests/support/small_bed.hpp"
#include "tests/support/tolerance.hpp"

namespace {

qdem::QdemCase read(const std::string& keys) {
  return qdem::read_qdem_case(proto::CaseFile::load(tests::small_bed_case(testing::TempDir(), keys)));
}

void expect_refused(const std::string& keys, const std::string& words) {
  try {
    read(keys);
    FAIL() << "accepted: " << keys;
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::config);
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

}  // namespace

TEST(QdemCase, ReadsMaterialsAndContact) {
  const auto settings = read("step_safety = 0.7\n");
  EXPECT_EQ(settings.step_safety, 0.7);
  EXPECT_EQ(settings.physics.stone.density, 2700);
  EXPECT_TRUE(tests::near_rel(settings.physics.stone.shear_viscosity, 1e-6 * settings.physics.stone.mu(), 1e-14));
  EXPECT_EQ(settings.physics.sleeper.lame_viscosity, 300);
  EXPECT_EQ(settings.physics.contact.friction, 0.6);
  EXPECT_EQ(settings.physics.ground_friction, 0.6);
}

TEST(QdemCase, RefusesWhatItCannotUse) {
  expect_refused("step_safty = 0.7\n", "step_safety");
  expect_refused("step_safety = 1.2\n", "qdem.step_safety");
  expect_refused("[[qdem.material]]\nname = \"stone\"\nyoung_pa = 1e9\npoisson = 0.2\ndensity_kg_per_m3 = 1\n",
                 "twice");
  expect_refused("[[qdem.material]]\nname = \"stoen\"\n", "stone");
  expect_refused("[qdem.run]\nload_time_s = [0, 1]\nload_force_n = [5]\n", "1 forces for 2 times");
  expect_refused("[qdem.run]\nload_time_s = [1, 1]\nload_force_n = [5, 6]\n", "do not ascend");
}
