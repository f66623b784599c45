// `[qdem]`: what is accepted, and what is refused with which words.
#include "qdem_solver/participant/qdem_case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "proto/error.hpp"
#include "qdem_solver/participant/track_bed.hpp"
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

namespace {

/// The small case with other keys in place of the contact's stiffness and damping.
qdem::ContactLaw contact(const std::string& keys) {
  const auto path = tests::small_bed_case(testing::TempDir(), "");
  std::ifstream in(path);
  std::string text, line;
  while (std::getline(in, line)) {
    if (line.find("normal_stiffness") == 0) line = keys;
    if (line.find("damping_ratio") == 0) continue;
    text += line + "\n";
  }
  in.close();
  std::ofstream(path) << text;
  return qdem::read_qdem_case(proto::CaseFile::load(path)).physics.contact;
}

}  // namespace

TEST(QdemCase, CalibratesTheContact) {
  // The small case has stones of 1 GPa, nu 0.25.
  const auto hertz = contact("hertz_load_n = 500.0\nhertz_radius_m = 5e-3\ndamping_ratio = 0.1\n");
  const double modulus = 1e9 / 2 / (1 - 0.25 * 0.25);
  EXPECT_TRUE(tests::near_rel(hertz.normal_stiffness, std::cbrt(6 * modulus * modulus * 5e-3 * 500), 1e-12));
  // Undamped: half a period of sqrt(k/m) with half a stone's mass.
  const auto timed = contact("contact_time_s = 1e-3\ncontact_mass_kg = 0.4\nrestitution = 1.0\n");
  EXPECT_TRUE(tests::near_rel(timed.normal_stiffness, 0.2 * std::pow(M_PI / 1e-3, 2), 1e-9));
  EXPECT_TRUE(tests::near_abs(timed.damping_ratio, 0.0, 1e-12));
}

TEST(QdemCase, RefusesAContactGivenTwiceOrByHalf) {
  const auto refusal = [](const std::string& keys) -> std::string {
    try {
      contact(keys);
    } catch (const proto::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string damping = "restitution = 0.8\n";
  EXPECT_NE(refusal("normal_stiffness_n_per_m = 1e7\nhertz_load_n = 1.0\n" + damping).find("twice"), std::string::npos);
  EXPECT_NE(refusal("hertz_load_n = 1.0\n" + damping).find("hertz_radius_m"), std::string::npos);
  EXPECT_NE(refusal(damping).find("normal_stiffness_n_per_m"), std::string::npos);
  EXPECT_NE(refusal("normal_stiffness_n_per_m = 1e7\n").find("give damping_ratio, or restitution"), std::string::npos);
  EXPECT_NE(refusal("normal_stiffness_n_per_m = 1e7\nrestitution = 0.05\n").find("restitution"), std::string::npos);
}

TEST(QdemCase, ReadsLoadHistories) {
  const auto load = [](const std::string& keys) { return read("[qdem.run.load]\n" + keys).run.load; };
  const auto table = load("kind = \"table\"\ntime_s = [1.0, 3.0]\nforce_n = [10.0, 30.0]\n");
  EXPECT_EQ(table(0.0), 10.0);
  EXPECT_TRUE(tests::near_rel(table(1.5), 15.0, 1e-14));
  EXPECT_EQ(table(9.0), 30.0);
  const auto impulse = load("kind = \"half_sine\"\npeak_n = 100.0\nduration_s = 0.01\nstart_s = 0.02\n");
  double sum = 0.0;
  for (int i = 0; i < 40000; ++i) sum += 1e-6 * impulse(1e-6 * (i + 0.5));
  EXPECT_TRUE(tests::near_rel(sum, 2 / M_PI * 100 * 0.01, 1e-6));
  const auto cyclic =
      load("kind = \"cyclic\"\nmean_n = 50.0\namplitude_n = 20.0\nfrequency_hz = 10.0\ncycles = 2\nstart_s = 0.1\n");
  EXPECT_TRUE(tests::near_rel(cyclic(0.05), 25.0, 1e-12));
  EXPECT_TRUE(tests::near_rel(cyclic(0.1 + 0.025), 70.0, 1e-12));
  EXPECT_TRUE(tests::near_rel(cyclic(0.1 + 0.175), 30.0, 1e-12));
  EXPECT_TRUE(tests::near_rel(cyclic(5.0), 50.0, 1e-12));
  EXPECT_FALSE(read("").run.load);
}

TEST(QdemCase, ReadsHowParticlesInteract) {
  using qdem::Interaction;
  EXPECT_EQ(read("").physics.stone.interaction, Interaction::quadruple);
  EXPECT_EQ(read("particle_interaction = \"quadruple\"\n").physics.stone.interaction, Interaction::quadruple);
  const auto physics = read("particle_interaction = \"bond\"\n").physics;
  EXPECT_EQ(physics.stone.interaction, Interaction::bond);
  EXPECT_EQ(physics.sleeper.interaction, Interaction::bond);
}

TEST(QdemCase, ReadsWhoMakesTheSteps) {
  using qdem::EngineKind;
  EXPECT_EQ(read("").engine, EngineKind::cpu);
  EXPECT_EQ(read("engine = \"cuda\"\n").engine, EngineKind::cuda);
  EXPECT_EQ(read("engine = \"check\"\n").engine, EngineKind::check);
}

TEST(QdemCase, AnEngineThatIsNotThereIsRefused) {
  const std::string missing = qdem::why_no_engine(qdem::EngineKind::cuda);
  if (missing.empty()) GTEST_SKIP() << "there is a CUDA device";
  const auto path = tests::small_bed_case(testing::TempDir(), "engine = \"cuda\"\n");
  try {
    qdem::check_case(proto::CaseFile::load(path));
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::config);
    for (const auto& part : {missing, std::string("qdem.engine"), std::string(".toml:20:10")}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

TEST(QdemCase, ALossFactorIsARetardationTime) {
  const auto file = [&](const std::string& damping) {
    std::string text = proto::CaseFile::load(tests::small_bed_case(testing::TempDir())).text();
    const std::string own = "retardation_time_s = 1e-6";
    text.replace(text.find(own), own.size(), damping);
    const std::string path = testing::TempDir() + "loss_factor.toml";
    std::ofstream(path) << text;
    return proto::CaseFile::load(path);
  };
  const auto by_loss = qdem::read_qdem_case(file("loss_factor = 0.01\nloss_factor_frequency_hz = 2000")).physics.stone;
  const double time = 0.01 / (2 * M_PI * 2000);
  EXPECT_TRUE(tests::near_rel(by_loss.shear_viscosity, time * by_loss.mu(), 1e-14));
  EXPECT_TRUE(tests::near_rel(by_loss.lame_viscosity, time * by_loss.lambda(), 1e-14));
  const auto refusal = [&](const std::string& damping) -> std::string {
    try {
      qdem::read_qdem_case(file(damping));
    } catch (const proto::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string loss = "loss_factor = 0.01\nloss_factor_frequency_hz = 2000\n";
  EXPECT_NE(refusal(loss + "retardation_time_s = 1e-7").find("given twice"), std::string::npos);
  EXPECT_NE(refusal(loss + "shear_viscosity_pa_s = 1").find("given twice"), std::string::npos);
  EXPECT_NE(refusal("loss_factor = 0.01").find("loss_factor_frequency_hz"), std::string::npos);
  EXPECT_NE(refusal("loss_factor_frequency_hz = 10").find("loss_factor"), std::string::npos);
}

TEST(QdemCase, RefusesWhatItCannotUse) {
  expect_refused("particle_interaction = \"bonds\"\n", "did you mean 'bond'");
  expect_refused("engine = \"gpu\"\n", "cuda");
  expect_refused("particle_interactoin = \"bond\"\n", "particle_interaction");
  expect_refused("step_safty = 0.7\n", "step_safety");
  expect_refused("step_safety = 1.2\n", "qdem.step_safety");
  expect_refused("[[qdem.material]]\nname = \"stone\"\nyoung_pa = 1e9\npoisson = 0.2\ndensity_kg_per_m3 = 1\n",
                 "twice");
  expect_refused("[[qdem.material]]\nname = \"stoen\"\n", "stone");
  expect_refused("[qdem.run.load]\nkind = \"table\"\ntime_s = [0, 1]\nforce_n = [5]\n", "1 forces for 2 times");
  expect_refused("[qdem.run.load]\nkind = \"table\"\ntime_s = [1, 1]\nforce_n = [5, 6]\n", "do not ascend");
  expect_refused("[qdem.run.load]\nkind = \"half_sin\"\n", "half_sine");
  expect_refused("[qdem.run.load]\nkind = \"half_sine\"\npeak_n = 5.0\n", "duration_s");
}
