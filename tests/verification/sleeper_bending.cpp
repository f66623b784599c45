// Tapered sleepers: volume and mass against closed forms, first free bending mode against a beam of varying section.
#include <gtest/gtest.h>

#include <map>

#include "qdem_solver/bed/sleeper_shape.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/free_modes.hpp"
#include "tests/support/tapered_beam.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using qdem::bed::SleeperShape;
using tests::near_rel;

/// Section at a place, written anew from the shape's numbers: height, bottom width, top width.
Vector3d lengths_at(const SleeperShape& shape, double place) {
  const auto& s = shape.sections;
  std::size_t i = 1;
  while (i + 1 < s.size() && s[i].place < place) ++i;
  const double share = (place - s[i - 1].place) / (s[i].place - s[i - 1].place);
  const Vector3d a(s[i - 1].height, s[i - 1].bottom_width, s[i - 1].top_width);
  return a + share * (Vector3d(s[i].height, s[i].bottom_width, s[i].top_width) - a);
}

double summed_volume(const SleeperShape& shape, int n = 20000) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const Vector3d x = lengths_at(shape, (i + 0.5) / n * shape.half_length());
    sum += x[0] * (x[1] + x[2]) / 2 * shape.half_length() / n;
  }
  return sum;
}

/// Both halves as one body.
qdem::Template whole(const qdem::Template& half) {
  auto nodes = half.nodes;
  auto tets = half.tets;
  std::map<int, int> twin;
  for (int i = 0; i < half.n_nodes(); ++i) {
    twin[i] = i;
    if (half.nodes[i][1] < 1e-12) continue;
    twin[i] = static_cast<int>(nodes.size());
    nodes.emplace_back(half.nodes[i][0], -half.nodes[i][1], half.nodes[i][2]);
  }
  for (const auto& t : half.tets) tets.push_back({twin[t[0]], twin[t[2]], twin[t[1]], twin[t[3]]});
  return qdem::make_template("whole sleeper", nodes, tets);
}

double frequency_of_mesh(const SleeperShape& shape, int cells, double guess) {
  const auto model = tests::free_bodies(whole(sleeper_mesh("sleeper", shape, cells)), tests::concrete());
  const auto modes = tests::free_modes(model.shape(0), model.materials[0], 1, guess);
  return tests::frequency(tests::vibration(model, modes[0].shape, 1.3 / modes[0].frequency, 0.9));
}

double frequency_of_beam(const SleeperShape& shape) {
  const auto concrete = tests::concrete();
  const auto section = [&](double x) {
    const Vector3d s = lengths_at(shape, std::abs(x - shape.half_length()));
    return tests::BeamSection::trapezoid(s[0], s[1], s[2]);
  };
  return tests::free_bending(section, 2 * shape.half_length(),
                                   {concrete.young, concrete.poisson, concrete.density});
}

}  // namespace

TEST(TaperedBeam, ThePrismIsTheKnownOne) {
  const auto prism = [](double) { return tests::BeamSection::trapezoid(0.17, 0.24, 0.24); };
  EXPECT_TRUE(near_rel(tests::free_bending(prism, 2.0, {40e9, 0.2, 2400}), 174.0, 1e-3));
}

TEST(TaperedSleeper, HasTheVolumeOfItsSections) {
  for (const char* name : {"3PR", "B70"}) {
    const auto shape = qdem::bed::known_sleeper(name);
    EXPECT_TRUE(near_rel(shape.volume(), summed_volume(shape), 1e-8)) << name;
    for (const int cells : {2, 4, 8}) {  // a mass to 0.1 % with the usual four bricks, and no worse than second order
      EXPECT_TRUE(near_rel(sleeper_mesh(name, shape, cells).volume(), shape.volume(), 1e-3 * 16 / (cells * cells)))
          << name << ", " << cells << " cells";
    }
  }
}

TEST(TaperedSleeper, HasThePublishedMass) {
  EXPECT_TRUE(near_rel(2 * 2400 * qdem::bed::known_sleeper("3PR").volume(), 160.0, 0.02));
  EXPECT_TRUE(near_rel(2 * 2440 * qdem::bed::known_sleeper("B70").volume(), 280.0, 0.02));
}

TEST(TaperedSleeper, ItsSeatIsPlaneAndItsBottomToo) {
  const auto shape = qdem::bed::known_sleeper("B70");
  const auto mesh = sleeper_mesh("B70", shape, 4);
  const auto [first, last] = shape.seat_range();
  int n_seat = 0;
  for (const Vector3d& x : mesh.nodes) {
    EXPECT_LE(x[2], 0.0);
    EXPECT_GE(x[2], -shape.height());
    if (x[2] < 0.0) continue;
    ++n_seat;
    EXPECT_TRUE(x[1] >= first - 1e-12 && x[1] <= last + 1e-12) << x.transpose();
  }
  EXPECT_GT(n_seat, 20);
}

TEST(TaperedSleeper, BendsLikeABeamOfVaryingSection) {
  for (const char* name : {"3PR", "B70"}) {
    const auto shape = qdem::bed::known_sleeper(name);
    const double beam = frequency_of_beam(shape);
    const double coarse = frequency_of_mesh(shape, 4, beam), fine = frequency_of_mesh(shape, 6, beam);
    const double limit = fine + (fine - coarse) / (std::pow(6.0 / 4.0, 2) - 1);  // errors fall with the square
    std::cout << name << ": beam " << beam << " Hz; " << coarse << ", " << fine << ", extrapolated " << limit
              << " Hz\n";
    EXPECT_TRUE(near_rel(limit, beam, 0.02)) << name;
    EXPECT_GT(coarse, fine);
  }
}
