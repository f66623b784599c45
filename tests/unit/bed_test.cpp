// Parts of the bed: gradation, stone templates, sleeper mesh, loose stack, porosity, settings, bed file.
#include <filesystem>
#include <fstream>
#include <map>

#include "proto/error.hpp"
#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/bed/lone_body.hpp"
#include "qdem_solver/bed/loose_stack.hpp"
#include "qdem_solver/bed/porosity.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/bed/sleeper_shape.hpp"
#include "qdem_solver/bed/stone_shape.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace tests;
using namespace qdem::bed;
using Eigen::Vector3d;

const Gradation sieves{{0.03, 0.04, 0.05, 0.063}, {0.0, 0.3, 0.8, 1.0}};

std::vector<Stone> draw(std::uint64_t seed, double volume) {
  Random random(seed, 1);
  return draw_stones(
      sieves, 5, [](int t, double size) { return (0.3 + 0.05 * t) * size * size * size; }, volume, random);
}

TEST(Gradation, DrawnStonesFollowTheSieveCurve) {
  const auto stones = draw(3, 0.05);
  ASSERT_GT(stones.size(), 500u);
  double total = 0;
  for (const Stone& s : stones) total += (0.3 + 0.05 * s.template_id) * std::pow(s.size, 3);
  for (const double sieve : {0.035, 0.04, 0.045, 0.05, 0.06}) {
    double passing = 0;
    for (const Stone& s : stones) passing += s.size <= sieve ? (0.3 + 0.05 * s.template_id) * std::pow(s.size, 3) : 0;
    EXPECT_TRUE(near_abs(passing / total, sieves.passing_at(sieve), 0.02)) << "sieve " << sieve;
  }
  EXPECT_TRUE(near_rel(sieves.size_at(0.5), 0.044, 1e-12));
}

TEST(Gradation, OneSeedOneSetOfStones) {
  const auto a = draw(3, 0.01), b = draw(3, 0.01), c = draw(4, 0.01);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].size, b[i].size);
    EXPECT_EQ(a[i].template_id, b[i].template_id);
  }
  EXPECT_NE(a[0].size, c[0].size);
}

StoneShapes few(std::uint64_t seed) {
  StoneShapes shapes;
  shapes.n_templates = 4, shapes.seed = seed;
  return shapes;
}

/// Every edge of a closed surface is passed once in each direction.
bool closed(const qdem::Template& shape) {
  std::map<std::pair<int, int>, int> passes;
  for (const auto& t : shape.triangles) {
    for (int k = 0; k < 3; ++k) ++passes[{t.nodes[k], t.nodes[(k + 1) % 3]}];
  }
  for (const auto& [edge, n] : passes) {
    if (n != 1 || passes.count({edge.second, edge.first}) != 1) return false;
  }
  return true;
}

TEST(StoneTemplates, AreClosedAndInRange) {
  const auto shapes = few(1);
  const auto stones = make_stone_templates(shapes);
  ASSERT_EQ(stones.templates.size(), 4u);
  for (const auto& stone : stones.templates) {
    EXPECT_GE(stone.n_tets(), 50);
    EXPECT_LE(stone.n_tets(), 100);
    EXPECT_TRUE(closed(stone));
    for (const double volume : stone.volumes) EXPECT_GT(volume, 0);
    Vector3d low = stone.nodes[0], high = low;
    for (const Vector3d& x : stone.nodes) low = low.cwiseMin(x), high = high.cwiseMax(x);
    const Vector3d extent = high - low;
    EXPECT_TRUE(near_rel(extent[1], 1.0, 1e-9));
    EXPECT_TRUE(extent[0] >= shapes.elongation.lowest - 1e-9 && extent[0] <= shapes.elongation.highest + 1e-9);
    EXPECT_TRUE(extent[2] >= shapes.flatness.lowest - 1e-9 && extent[2] <= shapes.flatness.highest + 1e-9);
    double flux = 0;  // volume by the divergence theorem over the skin
    for (const auto& t : stone.triangles) {
      flux += stone.nodes[t.nodes[0]].dot(stone.nodes[t.nodes[1]].cross(stone.nodes[t.nodes[2]])) / 6;
    }
    EXPECT_TRUE(near_rel(stone.volume(), flux, 1e-12));
  }
}

TEST(StoneTemplates, ReproducibleFromTheSeed) {
  const auto a = make_stone_templates(few(1)), b = make_stone_templates(few(1)), c = make_stone_templates(few(2));
  for (std::size_t t = 0; t < a.templates.size(); ++t) {
    ASSERT_EQ(a.templates[t].n_nodes(), b.templates[t].n_nodes());
    EXPECT_EQ(a.templates[t].tets, b.templates[t].tets);
    for (int i = 0; i < a.templates[t].n_nodes(); ++i) EXPECT_EQ(a.templates[t].nodes[i], b.templates[t].nodes[i]);
  }
  EXPECT_NE(a.templates[0].nodes[0], c.templates[0].nodes[0]);
}

TEST(Sleeper, BoxFillsItsVolume) {
  const auto box = box_shape("box", {-0.13, 0, -0.2}, {0.13, 1.2, 0}, 0.05);
  EXPECT_EQ(box.n_tets(), 5 * 24 * 4 * 6);
  EXPECT_TRUE(near_rel(box.volume(), 0.26 * 1.2 * 0.2, 1e-12));
  EXPECT_TRUE(closed(box));
}

TEST(Sleeper, ASleeperWithoutTaperIsABox) {
  const auto box = box_shape("box", {-0.13, 0, -0.2}, {0.13, 1.2, 0}, 0.05);
  const auto sleeper = sleeper_mesh("sleeper", box_sleeper(2.4, 0.26, 0.2), 4);
  ASSERT_EQ(box.tets, sleeper.tets);
  for (int i = 0; i < box.n_nodes(); ++i) EXPECT_EQ(box.nodes[i], sleeper.nodes[i]);
}

TEST(Porosity, OfOneCubeIsItsClosedForm) {
  qdem::Model model;
  model.materials.push_back({"rock", 6e10, 0.25, 2700, 0, 0});
  model.templates.push_back(box_shape("cube", Vector3d::Constant(-0.05), Vector3d::Constant(0.05), 0.05));
  model.bodies.emplace_back();
  make_batches(model);
  const auto state = make_state(model, {qdem::Placement{}});
  const Vector3d half = Vector3d::Constant(0.1);
  EXPECT_TRUE(near_abs(porosity(model, state, -half, half, 0.005, 0.0), 1 - 0.125, 1e-12));
  EXPECT_TRUE(near_abs(porosity(model, state, -half, half, 0.001, 0.002), 1 - std::pow(0.52, 3), 2e-3));
}

TEST(Porosity, OfAnAngleIsItsClosedForm) {
  auto mesh = box_mesh({2, 1, 2}, Vector3d::Constant(0.1));
  mesh.tets.resize(18);  // three of the four cells: the notch is at large x and z
  mesh.nodes.erase(mesh.nodes.begin() + 17), mesh.nodes.erase(mesh.nodes.begin() + 14);  // of the fourth alone
  for (auto& tet : mesh.tets) {
    for (int& node : tet) node -= node > 14;
  }
  qdem::Model model;
  model.templates.push_back(qdem::make_template("angle", mesh.nodes, mesh.tets));
  model.materials.push_back({"rock", 6e10, 0.25, 2700, 0, 0});
  model.bodies.emplace_back();
  make_batches(model);
  const auto state = make_state(model, {qdem::Placement{}});
  EXPECT_FALSE(is_convex(model.templates[0]));
  const Vector3d low = Vector3d::Constant(-0.05), high = Vector3d::Constant(0.15);
  EXPECT_TRUE(near_abs(porosity(model, state, low, high, 0.005, 0.0), 1 - 0.75 / 8, 1e-12));
  // Grown by r: the faces of the hull by r each, less the notch, which is r smaller on both sides.
  const double r = 0.004, whole = std::pow(0.1 + 2 * r, 3), notch = std::pow(0.05, 2) * (0.1 + 2 * r);
  EXPECT_TRUE(near_abs(porosity(model, state, low, high, 0.001, r), 1 - (whole - notch) / 0.008, 3e-3));
}

TEST(LooseStack, BoxesStayApartAndOnTheFloor) {
  const std::vector<qdem::Template> templates = {box_shape("long", {-0.7, -0.5, -0.3}, {0.7, 0.5, 0.3}, 0.5)};
  std::vector<Stone> stones(60, Stone{0, 0.05});
  Random random(1, 2);
  const std::vector<Rectangle> floor = {{0, 0.2, 0, 0.4}, {0.2, 0.5, 0, 0.4}};
  const auto places = stack_loosely(templates, stones, std::vector<double>(60, 0.05), floor, 0.1, 1e-3, random);
  std::vector<std::pair<Vector3d, Vector3d>> boxes;
  for (const auto& place : places) {
    Vector3d low = Vector3d::Constant(1e9), high = -low;
    for (const Vector3d& node : templates[0].nodes) {
      const Vector3d x = place.rotation * (0.05 * node) + place.translation;
      low = low.cwiseMin(x), high = high.cwiseMax(x);
    }
    EXPECT_GE(low[2], 0.1);
    EXPECT_TRUE(low[0] >= 0 && high[0] <= 0.5 && low[1] >= 0 && high[1] <= 0.4);
    for (const auto& [l, h] : boxes) {
      EXPECT_TRUE((low.array() > h.array()).any() || (high.array() < l.array()).any());
    }
    boxes.emplace_back(low, high);
  }
}

/// Writes a case of the given [bed] lines and returns its path.
std::string case_with(const std::string& bed) {
  const auto folder = std::filesystem::temp_directory_path() / ("bed_test_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto path = folder / "case.toml";
  std::ofstream(path) << "[track]\ngauge_m = 1.435\nsleeper_spacing_m = 0.6\n[[rail_seat]]\nname = \"seat\"\n"
                         "origin_m = [0.0, 0.7535, 0.0]\nlongitudinal_axis = [1, 0, 0]\nlateral_axis = [0, 1, 0]\n"
                         "half_lengths_m = [0.075, 0.07]\ncells = [1, 1]\nstiffness_n_per_m = [60e6, 60e6, 225e6]\n"
                         "damping_ns_per_m = [15e3, 15e3, 30e3]\nclip_preload_n = 20e3\ntension_cutoff = true\n[bed]\n"
                      << bed;
  return path.string();
}

std::string refusal(const std::string& bed) {
  try {
    read_settings(proto::CaseFile::load(case_with(bed)));
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::config);
    return error.what();
  }
  return {};
}

TEST(Sleeper, ItsFiguresAreThoseOfTheWholeOne) {
  qdem::BedPhysics physics;
  physics.sleeper = {"sleeper", 4e10, 0.2, 2400, 0, 0};
  const auto figures = qdem::sleeper_figures(
      proto::CaseFile::load(case_with("sleeper_length_m = 2.0\nsleeper_width_m = 0.24\nsleeper_height_m = 0.17\n")),
      physics);
  EXPECT_TRUE(near_rel(figures.mass, 2.0 * 0.24 * 0.17 * 2400, 1e-12));
  // Largest eigenvalue of the assembled linear elements of this mesh, by an eigen-solver that shares no code with ours.
  EXPECT_TRUE(near_rel(figures.step_bound, 6.42e-6, 0.01));
}

TEST(Settings, TakeStonesFromFiles) {
  const auto folder = std::filesystem::path(case_with("")).parent_path();
  for (const char* name : {"b.stl", "a.STL", "notes.txt"}) std::ofstream(folder / name) << "x";
  const auto files = [](const std::string& bed) {
    return read_settings(proto::CaseFile::load(case_with(bed))).shapes.files;
  };
  const std::vector<std::string> both = {(folder / "a.STL").string(), (folder / "b.stl").string()};
  EXPECT_EQ(files("stone_files = \".\"\n"), both);
  EXPECT_EQ(files("stone_files = \"*.[sS]*\"\n"), both);
  EXPECT_EQ(files("stone_files = \"b.stl\"\n"), std::vector<std::string>{both[1]});
  EXPECT_EQ(files(""), std::vector<std::string>{});
  EXPECT_NE(refusal("stone_files = \"*\"\n").find("ends on none of: .msh, .stl, .obj"), std::string::npos);
  EXPECT_NE(refusal("stone_files = \"b.stl\"\ntemplates = 3\n").find("bed.templates"), std::string::npos);
  try {
    files("stone_files = \"none/*.stl\"\n");
    ADD_FAILURE() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::missing_input);
    EXPECT_NE(std::string(error.what()).find("bed.stone_files"), std::string::npos) << error.what();
  }
}

TEST(BedHash, KnowsTheStonesContent) {
  const auto path = case_with("stone_files = \"s.stl\"\n");
  const auto folder = std::filesystem::path(path).parent_path();
  const auto hash = [&](const std::string& content) {
    std::ofstream(folder / "s.stl") << content;
    return qdem::bed_hash(proto::CaseFile::load(path), {});
  };
  const auto first = hash("one");
  EXPECT_NE(first, hash("two"));
  EXPECT_EQ(first, hash("one"));
  const auto generated = qdem::bed_hash(proto::CaseFile::load(case_with("")), {});
  EXPECT_NE(first, generated);
}

TEST(Settings, RefuseWhatCannotBe) {
  EXPECT_EQ(refusal("seed = 7\n"), "");
  EXPECT_NE(refusal("dept_m = 0.3\n").find("depth_m"), std::string::npos);
  EXPECT_NE(refusal("sleeper_length_m = 1.5\n").find("seat"), std::string::npos);
  EXPECT_NE(refusal("sieve_passing_percent = [0, 50, 100]\n").find("sieve"), std::string::npos);
  EXPECT_NE(refusal("sieve_sizes_m = [0.05, 0.04, 0.06, 0.07, 0.08]\n").find("ascend"), std::string::npos);
  EXPECT_NE(refusal("depth_m = -0.2\n"), "");
}

TEST(Settings, TakeSleepersByNameAndByDimensions) {
  const auto sleeper = [](const std::string& bed) {
    return read_settings(proto::CaseFile::load(case_with(bed))).sleeper;
  };
  EXPECT_EQ(sleeper("sleeper = \"B70\"\n").height(), 0.214);
  EXPECT_EQ(sleeper("sleeper = \"B70\"\nsleeper_length_m = 2.5\n").half_length(), 1.25);
  EXPECT_EQ(sleeper("sleeper = \"B70\"\nsleeper_end_m = [0.2, 0.31, 0.16]\n").width(), 0.31);
  const std::string own =
      "sleeper = \"tapered\"\nsleeper_length_m = 2.0\nsleeper_seat_range_m = [0.6, 0.9]\n"
      "sleeper_centre_m = [0.15, 0.22, 0.15]\nsleeper_seat_m = [0.17, 0.24, 0.18]\n";
  const auto shape = sleeper(own + "sleeper_end_m = [0.13, 0.24, 0.18]\n");
  EXPECT_TRUE(near_rel(shape.bottom_area(), 0.6 * 0.23 + 0.4 * 0.24, 1e-12));
  EXPECT_EQ(shape.seat_range(), std::pair(0.6, 0.9));
}

TEST(Settings, RefuseSleepersThatCannotBe) {
  EXPECT_NE(refusal("sleeper = \"B71\"\n").find("did you mean 'B70'"), std::string::npos);
  EXPECT_NE(refusal("sleeper = \"B70\"\nsleeper_width_m = 0.3\n").find("it is for a box"), std::string::npos);
  EXPECT_NE(refusal("sleeper_end_m = [0.2, 0.3, 0.2]\n").find("the sleeper is a box"), std::string::npos);
  EXPECT_NE(refusal("sleeper = \"tapered\"\n").find("bed.sleeper_centre_m"), std::string::npos);
  EXPECT_NE(refusal("sleeper = \"B70\"\nsleeper_end_m = [0.2, 0.3, 0.4]\n").find("top is wider"), std::string::npos);
  EXPECT_NE(refusal("sleeper = \"B70\"\nsleeper_end_m = [0.3, 0.3, 0.2]\n").find("higher than the rail seat"),
            std::string::npos);
  EXPECT_NE(refusal("sleeper = \"B70\"\nsleeper_length_m = 1.6\n").find("must begin before it ends"),
            std::string::npos);
  EXPECT_NE(refusal("sleeper = \"3PR\"\n").find("rail seat 'seat' reaches from 0.683"), std::string::npos);
  EXPECT_NE(refusal("sleeper = \"B70\"\nsleeper_seat_m = [0.21, 0.3, 0.14]\n").find("wider than the sleeper's top"),
            std::string::npos);
}

const std::string granite = "[[qdem.material]]\nname = \"granite\"\n";

TEST(Settings, TakeMaterialsByName) {
  const auto mixture = [](const std::string& bed) {
    return read_settings(proto::CaseFile::load(case_with(bed))).mixture;
  };
  EXPECT_EQ(mixture("").size(), 1u);
  EXPECT_EQ(mixture("")[0].material_id, 0);
  const auto two =
      mixture("stone_materials = [\"stone\", \"granite\"]\nstone_material_shares = [1.0, 3.0]\n" + granite);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[1].material_id, 2);
  EXPECT_EQ(two[1].share, 3.0);
  EXPECT_NE(refusal("stone_materials = [\"granit\"]\n" + granite).find("did you mean 'granite'?"), std::string::npos);
  EXPECT_NE(refusal("stone_materials = [\"slate\"]\n").find("there is no material 'slate'"), std::string::npos);
  EXPECT_NE(refusal("stone_material_shares = [1.0, 2.0]\n").find("as many shares as materials"), std::string::npos);
  EXPECT_NE(refusal("stone_material_shares = [-1.0]\n"), "");
}

TEST(Gradation, MixesMaterialsByVolume) {
  const auto volume_of = [](int t, double size) { return (0.3 + 0.05 * t) * size * size * size; };
  auto stones = draw(3, 0.05);
  mix_materials({{0, 1.0}, {2, 2.0}, {3, 1.0}}, volume_of, stones);
  std::map<int, double> volumes;
  double whole = 0.0, largest = 0.0;
  for (const Stone& stone : stones) {
    const double own = volume_of(stone.template_id, stone.size);
    volumes[stone.material_id] += own, whole += own, largest = std::max(largest, own);
  }
  ASSERT_EQ(volumes.size(), 3u);
  EXPECT_TRUE(near_abs(volumes[0], 0.25 * whole, largest));
  EXPECT_TRUE(near_abs(volumes[2], 0.5 * whole, largest));
}

TEST(BedHash, KnowsTheMixture) {
  qdem::BedPhysics physics;
  physics.others.resize(1);
  physics.others[0].young = 5e10;
  const auto hash = [&](const std::string& bed) {
    return qdem::bed_hash(proto::CaseFile::load(case_with(bed)), physics);
  };
  const std::string two = "stone_materials = [\"stone\", \"granite\"]\n";
  const auto first = hash(two + granite);
  EXPECT_NE(first, hash(two + "stone_material_shares = [1.0, 2.0]\n" + granite));
  physics.others[0].young = 6e10;
  EXPECT_NE(first, hash(two + granite));
  EXPECT_EQ(hash(""), hash(granite));  // named, not used
}

TEST(BedHash, KnowsWhichNumberAMaterialHas) {
  const auto hash = [](const std::vector<std::string>& order) {
    qdem::BedPhysics physics;
    physics.others.resize(2);
    std::string bed = "stone_materials = [\"granite\", \"basalt\"]\n";
    for (std::size_t i = 0; i < order.size(); ++i) {
      physics.others[i].young = order[i] == "granite" ? 5e10 : 8e10;
      auto table = granite;
      table.replace(table.find("granite"), 7, order[i]);
      bed += table;
    }
    return qdem::bed_hash(proto::CaseFile::load(case_with(bed)), physics);
  };
  EXPECT_NE(hash({"granite", "basalt"}), hash({"basalt", "granite"}));
}

TEST(BedHash, KnowsPadAndGround) {
  const auto file = proto::CaseFile::load(case_with(""));
  qdem::BedPhysics rigid, pad, ground;
  pad.lining = ground.ground = {1e6, 3e5, 100, 30, 1e-3};
  const auto bare = bed_hash(file, rigid), lined = bed_hash(file, pad);
  EXPECT_NE(bare, lined);
  EXPECT_NE(lined, bed_hash(file, ground));
}

TEST(BedHash, KnowsTheSleepersSections) {
  const auto hash = [](const std::string& bed) { return qdem::bed_hash(proto::CaseFile::load(case_with(bed)), {}); };
  const std::string known = "sleeper = \"B70\"\n";
  EXPECT_NE(hash(known), hash(known + "sleeper_end_m = [0.18, 0.3, 0.15]\n"));
  EXPECT_EQ(hash(""), hash("sleeper = \"box\"\n"));
}

TEST(BedHash, KnowsHowParticlesInteract) {
  const auto file = proto::CaseFile::load(case_with("seed = 7\n"));
  qdem::BedPhysics physics;
  const auto quadruples = bed_hash(file, physics);
  physics.sleeper.interaction = qdem::Interaction::bond;
  EXPECT_NE(bed_hash(file, physics), quadruples);
}

TEST(BedHash, KnowsWhichLawABedIsPouredWith) {
  const auto hash = [](const std::string& bed, qdem::Interaction of_run) {
    qdem::BedPhysics physics;
    physics.stone.interaction = physics.sleeper.interaction = of_run;
    return bed_hash(proto::CaseFile::load(case_with(bed)), physics);
  };
  const std::string otherwise = "poured_with = \"quadruple\"\n";
  EXPECT_EQ(hash("", qdem::Interaction::quadruple), hash(otherwise, qdem::Interaction::quadruple));
  EXPECT_NE(hash("", qdem::Interaction::bond), hash(otherwise, qdem::Interaction::bond));
}

TEST(LoneBody, ASleeperAloneWantsNoGravity) {
  EXPECT_NE(refusal("scene = \"sleeper\"\n").find("gravity_m_per_s2 = 0"), std::string::npos);
  EXPECT_EQ(refusal("scene = \"sleeper\"\n[qdem]\ngravity_m_per_s2 = 0.0\n"), "");
  EXPECT_NE(refusal("scene = \"stones\"\n").find("did you mean 'stone'"), std::string::npos);
}

/// However it is tilted, its centre rises over its lowest point.
TEST(LoneBody, AStoneStandsSafely) {
  const auto templates = make_stone_templates({4, {1.1, 1.7}, {0.55, 0.95}, 36, 80, 3}).templates;
  for (const qdem::Template& stone : templates) {
    Vector3d centre = Vector3d::Zero();
    for (int i = 0; i < stone.n_nodes(); ++i) centre += stone.node_volumes[i] / stone.volume() * stone.nodes[i];
    const auto height = [&](const Eigen::Matrix3d& rotation) {
      double lowest = 0.0;
      for (const Vector3d& node : stone.nodes) lowest = std::min(lowest, (rotation * (node - centre))[2]);
      return -lowest;
    };
    const Eigen::Matrix3d resting = resting_rotation(stone);
    for (int i = 0; i < 16; ++i) {
      const Vector3d axis(std::cos(i * M_PI / 8), std::sin(i * M_PI / 8), 0.0);
      EXPECT_GT(height(Eigen::AngleAxisd(0.01, axis) * resting), height(resting)) << stone.name << ", tilt " << i;
    }
  }
}

TEST(BedHash, KnowsTheContactLaw) {
  const auto file = proto::CaseFile::load(case_with("seed = 7\n"));
  qdem::BedPhysics physics;
  const auto facets = bed_hash(file, physics);
  physics.contact.shape = qdem::ContactShape::sphere;
  const auto spheres = bed_hash(file, physics);
  EXPECT_NE(spheres, facets);
  physics.contact.rolling_friction = 0.1;
  EXPECT_NE(bed_hash(file, physics), spheres);
}

}  // namespace
