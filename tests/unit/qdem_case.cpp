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

const std::string soil =
    "[[qdem.material]]\nname = \"soil\"\nyoung_pa = 5e7\npoisson = 0.3\ndensity_kg_per_m3 = 2000\n";
const std::string elements =
    "[qdem.subgrade]\nkind = \"layer\"\nmaterial = \"soil\"\nthickness_m = 1.0\nwidth_m = 3.0\n";

/// Writes the small case with `law` in its contact; returns its path.
std::string case_with_law(const std::string& keys, const std::string& law) {
  const auto path = tests::small_bed_case(testing::TempDir(), keys);
  std::string text = proto::CaseFile::load(path).text();
  const std::string contact = "[qdem.contact]\n";
  text.insert(text.find(contact) + contact.size(), law);
  std::ofstream(path) << text;
  return path;
}

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

TEST(QdemCase, ReadsTheLawOfSpheres) {
  const auto facets = read("").physics.contact;
  EXPECT_EQ(facets.shape, qdem::ContactShape::facet);
  const std::string keys = "normal_stiffness_n_per_m = 1e6\nlaw = \"sphere\"\ndamping_ratio = 0.1\n";
  const auto equal = contact(keys);
  EXPECT_EQ(equal.shape, qdem::ContactShape::sphere);
  EXPECT_EQ(equal.radii, qdem::SphereRadii::equal);
  EXPECT_EQ(equal.rolling_friction, 0.0);
  const auto by_edge = contact(keys + "sphere_radii = \"by_edge\"\nrolling_friction = 0.2\n");
  EXPECT_EQ(by_edge.radii, qdem::SphereRadii::by_edge);
  EXPECT_EQ(by_edge.rolling_friction, 0.2);
}

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
  const auto load = [](const std::string& keys) {
    const auto loads = read("[[qdem.run.load]]\n" + keys).run.loads;
    EXPECT_EQ(loads.size(), 1u);
    EXPECT_EQ(loads[0].target, qdem::LoadTarget::pads);
    return loads[0].load.history;
  };
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
  EXPECT_TRUE(read("").run.loads.empty());
}

TEST(QdemCase, ReadsSeveralLoadsOfEveryKind) {
  const auto loads = read(R"(
[[qdem.run.load]]
kind = "displacement_sine"
mean_m = 1e-3
amplitude_m = 1e-4
frequency_hz = 5.0
cycles = 3
[[qdem.run.load]]
on = "patch"
body = "stone_7"
centre_m = [0.1, 0.2, 0.3]
radius_m = 0.05
direction = [0, 1, 0]
kind = "displacement_table"
time_s = [0, 1]
displacement_m = [0, 2e-3]
stiffness_n_per_m = 1e8
[[qdem.run.load]]
kind = "drop_weight"
mass_kg = 50.0
drop_height_m = 0.2
stiffness_n_per_m = 1e7
damping_ns_per_m = 100.0
start_s = 0.01
[[qdem.run.load]]
on = "patch"
centre_m = [0, 0, 0]
half_lengths_m = [0.1, 0.2, 0.3]
kind = "drop_weight"
mass_kg = 50.0
impact_velocity_m_per_s = 0.7
stiffness_n_per_m = 1e7
)")
                         .run.loads;
  ASSERT_EQ(loads.size(), 4u);
  EXPECT_EQ(loads[0].load.kind, qdem::LoadKind::displacement);
  EXPECT_TRUE(tests::near_rel(loads[0].load.history(0.05), 1.1e-3, 1e-12));
  EXPECT_EQ(loads[1].target, qdem::LoadTarget::patch);
  EXPECT_EQ(loads[1].body, "stone_7");
  EXPECT_EQ(loads[1].region.radius, 0.05);
  EXPECT_EQ(loads[1].direction, Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(loads[1].load.stiffness, 1e8);
  EXPECT_EQ(loads[1].load.history(0.5), 1e-3);
  EXPECT_EQ(loads[2].target, qdem::LoadTarget::pads);
  EXPECT_TRUE(tests::near_rel(loads[2].load.speed, std::sqrt(2 * 9.81 * 0.2), 1e-12));
  EXPECT_EQ(loads[2].load.start, 0.01);
  EXPECT_EQ(loads[3].body, "sleeper");
  EXPECT_EQ(loads[3].load.speed, 0.7);
  EXPECT_EQ(loads[3].region.half_lengths[1], 0.2);
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

TEST(QdemCase, ADeviceEngineIsRefusedWhatItDoesNotKnow) {
  const auto refusal = [](const std::string& tables, const std::string& law = "") -> std::string {
    const auto path = case_with_law("engine = \"check\"\n" + tables, law);
    try {
      qdem::check_case(proto::CaseFile::load(path));
      return "accepted";
    } catch (const proto::Error& error) {
      EXPECT_EQ(error.code(), proto::ExitCode::config);
      EXPECT_NE(std::string(error.what()).find("qdem.engine"), std::string::npos) << error.what();
      return error.what();
    }
  };
  const auto expect = [](const std::string& said, const std::string& words) {
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  const std::string layer =
      "bedding_modulus_n_per_m3 = 2e8\nfootprint_m2 = 1e-3\nloss_factor = 0.2\n"
      "loss_factor_frequency_hz = 40.0\n";
  EXPECT_EQ(refusal(""), "accepted");
  expect(refusal("", "law = \"sphere\"\n"), "contact spheres");
  expect(refusal(soil + elements + "element_m = 0.1\n"), "a subgrade of elements");
  expect(refusal("[qdem.under_sleeper_pad]\n" + layer), "a pad under the sleeper");
  expect(refusal("[qdem.under_ballast_mat]\n" + layer), "ground that gives way");
  const std::string weight = "[[qdem.run.load]]\nkind = \"drop_weight\"\nmass_kg = 10.0\ndrop_height_m = 0.002\n";
  expect(refusal(weight + "stiffness_n_per_m = 1e6\n"), "loads on patches");
  EXPECT_EQ(refusal("[[qdem.run.load]]\nkind = \"table\"\ntime_s = [0.0, 1.0]\nforce_n = [0.0, 1.0]\n"), "accepted");
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

namespace {

const std::string pad =
    "[qdem.under_sleeper_pad]\nbedding_modulus_n_per_m3 = 2e8\nfootprint_m2 = 1e-3\nloss_factor = 0.2\n"
    "loss_factor_frequency_hz = 30\n";

}  // namespace

TEST(QdemCase, ReadsLayersAndSubgrade) {
  EXPECT_TRUE(read("").physics.lining.is_rigid());
  EXPECT_TRUE(read("").physics.ground.is_rigid());
  const auto lining = read(pad).physics.lining;
  EXPECT_TRUE(tests::near_rel(lining.normal_stiffness, 2e5, 1e-12));
  EXPECT_TRUE(tests::near_rel(lining.tangential_stiffness, 6e4, 1e-12));
  EXPECT_TRUE(tests::near_rel(lining.normal_damping, 0.2 * 2e5 / (2 * M_PI * 30), 1e-12));
  const std::string half_space =
      "[qdem.subgrade]\nkind = \"half_space\"\nmaterial = \"soil\"\nfootprint_radius_m = 0.05\n";
  const auto ground = read(soil + half_space).physics.ground;
  EXPECT_TRUE(tests::near_rel(ground.normal_stiffness, 4 * 5e7 / 2.6 * 0.05 / 0.7, 1e-12));
  const auto both =
      read(soil + half_space + "[qdem.under_ballast_mat]\nbedding_modulus_n_per_m3 = 5e7\nfootprint_m2 = 8e-3\n")
          .physics;
  EXPECT_TRUE(tests::near_rel(1 / both.ground.normal_stiffness, 1 / ground.normal_stiffness + 1 / 4e5, 1e-12));
}

TEST(QdemCase, RefusesLayersThatCannotBe) {
  expect_refused("[qdem.under_sleeper_pad]\nbedding_modulus_n_per_m3 = 2e8\n", "qdem.under_sleeper_pad.footprint_m2");
  expect_refused("[qdem.under_sleeper_pad]\nbedding_modulus_n_per_m3 = -2e8\nfootprint_m2 = 1e-3\n", "greater than 0");
  expect_refused(pad + "shear_ratio = 0.0\n", "qdem.under_sleeper_pad.shear_ratio");
  expect_refused(pad + "damping = 1.0\n", "qdem.under_sleeper_pad.damping");
  expect_refused("[qdem.under_sleeper_mat]\nfootprint_m2 = 1e-3\n", "did you mean 'under_sleeper_pad'");
  expect_refused("[qdem.under_ballast_mat]\nbedding_modulus_n_per_m3 = 2e8\nfootprint_m2 = 1e-3\nloss_factor = 0.1\n",
                 "loss_factor_frequency_hz");
  expect_refused("[qdem.subgrade]\nkind = \"halfspace\"\n", "did you mean 'half_space'");
  expect_refused(soil + "[qdem.subgrade]\nkind = \"half_space\"\nmaterial = \"sol\"\nfootprint_radius_m = 0.05\n",
                 "did you mean 'soil'");
  expect_refused("[qdem.subgrade]\nfootprint_radius_m = 0.05\n", "footprint_radius_m");
}

TEST(QdemCase, ReadsASubgradeOfElements) {
  EXPECT_FALSE(read("").physics.subgrade);
  const auto physics = read("particle_interaction = \"bond\"\n" + soil + elements +
                            "element_m = 0.1\nboundary_stiffness = [1.2, 0.6]\nhighest_frequency_hz = 80.0\n")
                           .physics;
  ASSERT_TRUE(physics.subgrade);
  const qdem::SubgradeLayer& layer = *physics.subgrade;
  EXPECT_EQ(layer.material.density, 2000);
  EXPECT_EQ(layer.material.interaction, qdem::Interaction::quadruple);
  EXPECT_EQ(layer.thickness, 1.0);
  EXPECT_EQ(layer.width, 3.0);
  EXPECT_EQ(layer.element, 0.1);
  EXPECT_EQ(layer.normal_stiffness, 1.2);
  EXPECT_EQ(layer.tangential_stiffness, 0.6);
  EXPECT_EQ(layer.highest_frequency, 80.0);
  EXPECT_TRUE(physics.ground.is_rigid());
  EXPECT_EQ(physics.materials().back().name, "soil");
  EXPECT_TRUE(tests::near_rel(layer.resolved_frequency(), std::sqrt(5e7 / 2.6 / 2000) / 1.0, 1e-12));
}

TEST(QdemCase, RefusesASubgradeOfElementsThatCannotBe) {
  expect_refused(soil + elements, "qdem.subgrade.element_m");
  expect_refused(soil + elements + "element_m = -0.1\n", "greater than 0");
  expect_refused(soil + elements + "element_m = 1.5\n", "larger than the layer is thick");
  expect_refused(soil + elements + "element_m = 0.1\nboundary_stiffness = [1.0]\n", "two numbers");
  expect_refused(soil + elements + "element_m = 0.1\nboundary_stiffness = [0.0, 0.5]\n", "sinks under the weight");
  expect_refused(soil + elements + "element_m = 0.1\nfootprint_radius_m = 0.1\n", "footprint_radius_m");
  expect_refused(soil + "[qdem.subgrade]\nkind = \"layer\"\nmaterial = \"soil\"\nthickness_m = -1.0\n",
                 "qdem.subgrade.thickness_m");
  expect_refused(soil + elements + "element_m = 0.1\n" +
                     "[qdem.under_ballast_mat]\nbedding_modulus_n_per_m3 = 5e7\nfootprint_m2 = 8e-3\n",
                 "cannot carry [qdem.under_ballast_mat]");
  try {
    qdem::read_qdem_case(
        proto::CaseFile::load(case_with_law(soil + elements + "element_m = 0.1\n", "law = \"sphere\"\n")));
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_NE(std::string(error.what()).find("fall between the particles"), std::string::npos) << error.what();
  }
}

TEST(QdemCase, RefusesWhatItCannotUse) {
  expect_refused("particle_interaction = \"bonds\"\n", "did you mean 'bond'");
  expect_refused("engine = \"gpu\"\n", "cuda");
  expect_refused("particle_interactoin = \"bond\"\n", "particle_interaction");
  expect_refused("step_safty = 0.7\n", "step_safety");
  expect_refused("step_safety = 1.2\n", "qdem.step_safety");
  expect_refused("[[qdem.material]]\nname = \"stone\"\nyoung_pa = 1e9\npoisson = 0.2\ndensity_kg_per_m3 = 1\n",
                 "twice");
  const std::string own = "young_pa = 1e9\npoisson = 0.2\ndensity_kg_per_m3 = 1\n";
  expect_refused("[[qdem.material]]\nname = \"stoen\"\n" + own, "did you mean 'stone'");
  expect_refused("[[qdem.material]]\nname = \"granite\"\n" + own, "nothing is made of the material 'granite'");
  expect_refused("[[qdem.run.load]]\nkind = \"table\"\ntime_s = [0, 1]\nforce_n = [5]\n", "1 values for 2 times");
  expect_refused("[[qdem.run.load]]\nkind = \"table\"\ntime_s = [1, 1]\nforce_n = [5, 6]\n", "do not ascend");
  expect_refused("[[qdem.run.load]]\nkind = \"half_sin\"\n", "half_sine");
  expect_refused("[[qdem.run.load]]\nkind = \"half_sine\"\npeak_n = 5.0\n", "duration_s");
  const std::string patch = "[[qdem.run.load]]\non = \"patch\"\ncentre_m = [0, 0, 0]\n";
  const std::string weight = "kind = \"drop_weight\"\nmass_kg = 1.0\nstiffness_n_per_m = 1e6\n";
  const std::string foot = "[[qdem.run.load]]\nkind = \"displacement_table\"\ntime_s = [0]\ndisplacement_m = [0]\n";
  expect_refused(patch + weight + "drop_height_m = 1.0\n", "radius_m or half_lengths_m");
  expect_refused(patch + "radius_m = 1.0\n" + weight, "impact is missing");
  expect_refused(patch + "radius_m = 1.0\ndrop_height_m = 1.0\nimpact_velocity_m_per_s = 1.0\n" + weight, "twice");
  expect_refused(patch + "radius_m = 1.0\ndirection = [0, 0, 0]\n" + weight, "no length");
  expect_refused(patch + "radius_m = 1.0\ndirection = [0, 1]\n" + weight, "direction");
  expect_refused(patch + "radius_m = 1.0\nkind = \"displacement_table\"\ntime_s = [0]\ndisplacement_m = [0]\n",
                 "stiffness_n_per_m");
  expect_refused(foot + foot, "another load");
  expect_refused("[qdem.run.load]\nkind = \"half_sine\"\npeak_n = 5.0\nduration_s = 1.0\n", "load");
}
