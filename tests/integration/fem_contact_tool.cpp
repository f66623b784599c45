// `fem_solver contact` as a program: what it writes, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using proto::ExitCode;
using tests::near_rel;

constexpr const char* wheel_on_rail = R"([contact]
normal_force_n = 80e3
friction = 0.3
wheel_radius_m = 0.43
rail_crown_radius_m = 0.3
longitudinal_creepage = 1e-3
spin_per_m = 0.1
curve_factors = [0.2, 1.0, 10.0]
)";

struct Outcome {
  ExitCode code;
  std::string text;
};

/// Runs the tool of `program` on a case of this text, its output in `folder`.
Outcome contact(const std::string& text, const tests::TemporaryFolder& folder,
                const std::string& program = "fem_solver") {
  const std::string path = folder.path() + "/case.toml", log = folder.path() + "/log";
  std::ofstream(path) << text;
  const std::string command = std::string(HOUSE_BIN_DIR) + "/" + program + " contact " + path + " --out " +
                              folder.path() + " >" + log + " 2>&1";
  const int status = std::system(command.c_str());
  return {static_cast<ExitCode>(WEXITSTATUS(status)), tests::read_text(log)};
}

TEST(ContactTool, writes_patch_and_curve) {
  const tests::TemporaryFolder folder;
  const Outcome run = contact(wheel_on_rail, folder);
  ASSERT_EQ(run.code, ExitCode::ok) << run.text;
  EXPECT_NE(run.text.find("Hertz: semi-axes 6.43"), std::string::npos) << run.text;
  const proto::ResultReader file(folder.path() + "/contact.h5");
  const auto value = [&](const char* name) { return file.read(name).values.at(0); };
  const auto pressure = file.read("element/pressure").values, shear_x = file.read("element/shear_x").values;
  const auto x = file.read("element/x").values, zone = file.read("element/zone").values;
  ASSERT_EQ(pressure.size(), static_cast<std::size_t>(value("grid/n_x") * value("grid/n_y")));
  EXPECT_TRUE(near_rel(*std::max_element(pressure.begin(), pressure.end()), 1173e6, 0.01));
  const double area = std::pow(x[1] - x[0], 2) * 5.061 / 6.433;  // of an element
  double normal = 0.0, shear = 0.0;
  for (std::size_t k = 0; k < pressure.size(); ++k) {
    normal += pressure[k] * area, shear += shear_x[k] * area;
    EXPECT_EQ(zone[k] == 0, pressure[k] == 0);
  }
  EXPECT_TRUE(near_rel(normal, 80e3, 1e-3));
  EXPECT_TRUE(near_rel(shear, value("shear/longitudinal"), 1e-3));
  const auto curve = file.read("curve/longitudinal_force").values;
  ASSERT_EQ(curve.size(), 3u);
  EXPECT_TRUE(near_rel(curve[1], value("shear/longitudinal"), 1e-3));
  EXPECT_LT(curve[2], curve[1]);
  EXPECT_LT(curve[1], curve[0]);
}

TEST(ContactTool, reads_profiles) {
  const tests::TemporaryFolder folder;
  std::ofstream wheel(folder.path() + "/wheel.txt"), rail(folder.path() + "/rail.txt");
  for (int k = -20; k <= 20; ++k) {
    wheel << k * 1e-3 << " 0.0\n";
    rail << k * 1e-3 << " " << -k * k * 1e-6 / 2 / 0.3 << "\n";
  }
  wheel.close(), rail.close();
  const std::string text =
      "[contact]\nnormal_force_n = 80e3\nfriction = 0.3\nwheel_radius_m = 0.43\nwheel_profile = "
      "\"wheel.txt\"\nrail_profile = "
      "\"rail.txt\"\nmotion = \"shift\"\nlongitudinal_shift_m = 1e-5\n";
  const Outcome without = contact(text, folder);
  EXPECT_EQ(without.code, ExitCode::config);
  EXPECT_NE(without.text.find("contact.grid.elements"), std::string::npos) << without.text;
  const Outcome run = contact(text + "[contact.grid]\nelements = [26, 26]\nelement_m = [0.6e-3, 0.5e-3]\n", folder);
  ASSERT_EQ(run.code, ExitCode::ok) << run.text;
  const proto::ResultReader file(folder.path() + "/contact.h5");
  EXPECT_TRUE(near_rel(file.read("normal/approach").values.at(0), 90.8e-6, 0.01));
  EXPECT_LT(file.read("shear/longitudinal").values.at(0), -1e3);
}

// The reference: two blocks of finite elements, coarse here; fem_beam has none.
TEST(ContactTool, solves_blocks) {
  const tests::TemporaryFolder folder;
  const std::string text =
      "[contact]\nnormal_force_n = 80e3\nfriction = 0.3\nwheel_radius_m = 0.43\nrail_crown_radius_m = 0.3\nbodies = "
      "\"blocks\"\nmotion = \"shift\"\nlongitudinal_shift_m = -1e-5\n[contact.grid]\nelements_per_semi_axis = 4\n";
  const Outcome run = contact(text, folder);
  ASSERT_EQ(run.code, ExitCode::ok) << run.text;
  const proto::ResultReader file(folder.path() + "/contact.h5");
  EXPECT_TRUE(near_rel(file.read("normal/approach").values.at(0), 90.8e-6, 0.05));
  EXPECT_TRUE(near_rel(file.read("normal/force").values.at(0), 80e3, 1e-8));
  EXPECT_GT(file.read("shear/longitudinal").values.at(0), 1e3);
  const Outcome beam = contact(text, folder, "fem_beam");
  EXPECT_EQ(beam.code, ExitCode::config);
  EXPECT_NE(beam.text.find("fem_beam has no solid elements - contact.bodies"), std::string::npos) << beam.text;
}

TEST(ContactTool, refuses_bad_input_by_name) {
  const tests::TemporaryFolder folder;
  const auto with = [](const std::string& key, const std::string& value) {
    std::string text = wheel_on_rail;
    const auto begin = text.find(key + " = ") + key.size() + 3;
    return text.replace(begin, text.find('\n', begin) - begin, value);
  };
  for (const char* friction : {"-0.1", "1.5"}) {
    const Outcome run = contact(with("friction", friction), folder);
    EXPECT_EQ(run.code, ExitCode::config);
    EXPECT_NE(run.text.find("case.toml:3:12: contact.friction"), std::string::npos) << run.text;
  }
  EXPECT_NE(contact(with("curve_factors", "[1.0]\nspinn = 1.0"), folder).text.find("contact.spinn"), std::string::npos);
  const Outcome narrow = contact(
      std::string(wheel_on_rail) + "[contact.grid]\nmargin = 1.0\n" + "elements = [10, 10]\nelement_m = [1e-3, 1e-3]\n",
      folder);
  EXPECT_EQ(narrow.code, ExitCode::config) << narrow.text;  // two ways at once: margin is left unread
  const Outcome small =
      contact(std::string(wheel_on_rail) + "[contact.grid]\nelements = [10, 10]\nelement_m = [1e-3, 1e-3]\n", folder);
  EXPECT_EQ(small.code, ExitCode::numerics);
  EXPECT_NE(small.text.find("reaches the edge of its grid"), std::string::npos) << small.text;
}

}  // namespace
