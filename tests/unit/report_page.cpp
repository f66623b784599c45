// What coupler report puts into its page: numbers, surfaces, texts, and how much of them fits.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <limits>

#include "coupler/page/encode.hpp"
#include "coupler/page/page.hpp"
#include "coupler/page/part.hpp"
#include "coupler/page/run_facts.hpp"
#include "coupler/page/run_tables.hpp"
#include "coupler/page/scene.hpp"
#include "coupler/study/mesh.hpp"
#include "proto/error.hpp"
#include "proto/result/field_series.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using coupler::study::Mesh;
using namespace coupler::page;
using nlohmann::json;
using tests::near_abs;

std::string bytes_of(const std::string& text) {
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  unsigned group = 0, n_bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6 | static_cast<unsigned>(letters.find(c)), n_bits += 6;
    if (n_bits >= 8) n_bits -= 8, result += static_cast<char>(group >> n_bits & 255);
  }
  return result;
}

template <class T>
std::vector<T> numbers_of(const std::string& text) {
  const auto bytes = bytes_of(text);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::vector<double> values_of(const json& quantised) {
  std::vector<double> values;
  for (const auto integer : numbers_of<std::int16_t>(quantised["i16"]))
    values.push_back(integer * quantised["step"].get<double>());
  return values;
}

TEST(Encode, Base64OfTheStandard) {
  for (const auto& [plain, coded] :
       std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                        {"f", "Zg=="},
                                                        {"fo", "Zm8="},
                                                        {"foo", "Zm9v"},
                                                        {"foob", "Zm9vYg=="},
                                                        {"fooba", "Zm9vYmE="},
                                                        {"foobar", "Zm9vYmFy"}}) {  // RFC 4648, section 10
    EXPECT_EQ(base64(plain.data(), plain.size()), coded);
    EXPECT_EQ(base64_length(plain.size()), coded.size());
  }
}

TEST(Encode, QuantisedWithinHalfAStep) {
  std::vector<double> values;
  for (int i = -50; i <= 50; ++i) values.push_back(3e-4 * std::sin(0.37 * i) * i / 50.0);
  const auto coded = quantised_json(values);
  const auto decoded = values_of(coded);
  ASSERT_EQ(decoded.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_LE(std::abs(decoded[i] - values[i]), 0.5001 * coded["step"].get<double>()) << i;
  EXPECT_LE(coded["step"].get<double>(), 3e-4 / 32767);
}

TEST(Encode, QuantisedWithoutSizeOrNumber) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantise({0.0, 0.0}).values, (std::vector<std::int16_t>{0, 0}));
  EXPECT_EQ(quantise({std::nan(""), -2.0, infinity}).values, (std::vector<std::int16_t>{-32768, -32767, -32768}));
  EXPECT_EQ(quantise({1e-320}).values.front(), 32767) << "too small a number for its step";
}

TEST(Encode, NoTextEndsTheScript) {
  const json hostile = {{"name", "</script><img src=x onerror=alert(1)><!-- & \u2028"}, {"bytes", "\xff\xfe"}};
  const auto text = script_text(hostile);
  EXPECT_EQ(text.find_first_of("<>&"), std::string::npos) << text;
  for (const char c : text) EXPECT_TRUE(c >= 32 && c < 127);
  EXPECT_EQ(json::parse(text)["name"], hostile["name"]) << "what is escaped is read back";
}

TEST(Page, DataStandsWhereItsPlaceIs) {
  EXPECT_EQ(filled_page("a __RUN_DATA__ b", {{"x", "$&<"}}), "a {\"x\":\"$\\u0026\\u003c\"} b");
  for (const char* page : {"", "__RUN_DATA__ __RUN_DATA__"}) EXPECT_THROW(filled_page(page, {}), proto::Error);
}

/// A box of cells that are cut into tetrahedra, as sleeper or as stones.
Mesh box(std::array<int, 3> cells, bool sleeper = false, std::int64_t body = 0) {
  const auto shape = tests::box_mesh(cells, {0.3, 0.2, 0.1});
  Mesh mesh;
  for (const auto& node : shape.nodes) mesh.points.insert(mesh.points.end(), node.data(), node.data() + 3);
  for (const auto& element : shape.tets) {
    mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    for (int k = 0; k < 4; ++k)
      mesh.corners.push_back(static_cast<std::uint32_t>(element[static_cast<std::size_t>(k)]));
    mesh.types.push_back(10), mesh.bodies.push_back(body), mesh.sleeper.push_back(sleeper);
  }
  mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  return mesh;
}

double volume_inside(const Mesh& mesh, const Surface& surface) {
  double six_volumes = 0.0;
  for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) {
      const auto point = surface.points[surface.triangles[t + static_cast<std::size_t>(k)]];
      corners.col(k) = Eigen::Vector3d(mesh.points[3 * point], mesh.points[3 * point + 1], mesh.points[3 * point + 2]);
    }
    six_volumes += corners.determinant();
  }
  return six_volumes / 6;
}

TEST(SurfaceOfABox, IsClosedAndFacesOutwards) {
  const auto mesh = box({4, 3, 2});
  const auto surface = surface_of(mesh);
  EXPECT_EQ(surface.triangles.size() / 3, 2u * 2u * (4 * 3 + 3 * 2 + 4 * 2));
  EXPECT_EQ(surface.points.size(), 60u - 6u) << "5 x 4 x 3 points without the 3 x 2 x 1 inside";
  EXPECT_TRUE(near_abs(volume_inside(mesh, surface), 0.3 * 0.2 * 0.1, 1e-15));
}

TEST(SurfaceOfHexahedra, IsThatOfTheirUnion) {
  Mesh mesh;
  for (const double x : {0.0, 1.0, 2.0})
    for (const auto& [y, z] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      mesh.points.insert(mesh.points.end(), {x, static_cast<double>(y), static_cast<double>(z)});
  for (const std::uint32_t first : {0u, 4u}) {
    mesh.offsets.push_back(8 * first / 4);
    for (std::uint32_t k = 0; k < 8; ++k) mesh.corners.push_back(first + k);
    mesh.types.push_back(12), mesh.bodies.push_back(0), mesh.sleeper.push_back(false);
  }
  mesh.offsets.push_back(16);
  const auto surface = surface_of(mesh);
  EXPECT_EQ(surface.triangles.size() / 3, 20u) << "ten squares";
  EXPECT_TRUE(near_abs(std::abs(volume_inside(mesh, surface)), 2.0, 1e-14));
}

TEST(SurfaceOfBodies, SleepersFirstAndRangesApart) {
  auto mesh = box({1, 1, 1}, false, 7);
  const auto other = box({2, 1, 1}, true, 9);
  const auto n_points = static_cast<std::uint32_t>(mesh.n_points()), n_corners = mesh.offsets.back();
  mesh.offsets.pop_back();
  for (const auto offset : other.offsets) mesh.offsets.push_back(offset + n_corners);
  for (const auto corner : other.corners) mesh.corners.push_back(corner + n_points);
  for (const auto value : other.points) mesh.points.push_back(value + 1);
  for (std::size_t i = 0; i < other.n_cells(); ++i)
    mesh.types.push_back(10), mesh.bodies.push_back(9), mesh.sleeper.push_back(true);
  const auto surface = surface_of(mesh);
  ASSERT_EQ(surface.bodies.size(), 2u);
  EXPECT_EQ(surface.bodies[0].number, 9);
  EXPECT_TRUE(surface.bodies[0].sleeper);
  EXPECT_EQ(surface.bodies[1].number, 7);
  EXPECT_EQ(surface.bodies[1].first_point, surface.bodies[0].n_points);
  for (const auto& body : surface.bodies) {
    for (std::size_t i = 3 * body.first_triangle; i < 3 * (body.first_triangle + body.n_triangles); ++i) {
      EXPECT_GE(surface.triangles[i], body.first_point);
      EXPECT_LT(surface.triangles[i], body.first_point + body.n_points);
    }
  }
}

TEST(EvenlySpaced, KeepsBothEnds) {
  EXPECT_EQ(evenly_spaced(5, 9), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(evenly_spaced(81, 5), (std::vector<std::size_t>{0, 20, 40, 60, 80}));
  EXPECT_EQ(evenly_spaced(100, 2), (std::vector<std::size_t>{0, 99}));
  EXPECT_EQ(evenly_spaced(3, 1), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(evenly_spaced(0, 4).empty());
}

/// qdem.h5 of one stone that moves by (t, 0, -2 t) and is stressed by 1e6 t.
void write_stone(const std::string& path, int n_steps) {
  const auto mesh = box({2, 2, 2});
  proto::FieldSeriesOptions options;
  const std::vector<std::int64_t> corners(mesh.corners.begin(), mesh.corners.end());
  options.mesh = proto::OutputMesh::of_one_type(mesh.points, corners, proto::CellType::tetrahedron);
  options.fields = {{"displacement", "m", "", proto::Location::point, 3},
                    {"velocity", "m/s", "", proto::Location::point, 3},
                    {"von_mises_stress", "Pa", "", proto::Location::cell, 1}};
  const std::vector<float> zeros(mesh.n_cells(), 0.f);
  options.static_fields = {{{"body", "1", "", proto::Location::cell, 1}, zeros},
                           {{"sleeper", "1", "", proto::Location::cell, 1}, zeros}};
  auto file = proto::FieldSeriesFile::create(path, options);
  for (int step = 0; step < n_steps; ++step) {
    const double t = 1e-3 * step;
    std::vector<double> displacement, velocity;
    for (std::size_t i = 0; i < mesh.n_points(); ++i) {
      displacement.insert(displacement.end(), {t, 0, -2 * t}), velocity.insert(velocity.end(), {3, 0, 4});
    }
    file.begin_step(t);
    file.put("displacement", displacement), file.put("velocity", velocity);
    file.put("von_mises_stress", std::vector<double>(mesh.n_cells(), 1e6 * t));
    file.end_step();
  }
  file.close();
}

TEST(SceneOfARun, HoldsTheFieldsOfTheFile) {
  const tests::TemporaryFolder folder;
  write_stone(folder.file("qdem.h5"), 11);
  const auto scene = scene_json(folder.path(), 1000000);
  EXPECT_EQ(scene["outputs"], 11);
  EXPECT_EQ(scene["frames"].size(), 11u);
  const auto& part = scene["parts"][0];
  EXPECT_EQ(part["bodies"][0]["kind"], "stone");
  EXPECT_EQ(numbers_of<float>(part["points"]).size(), 3u * 26u);
  const auto& frame = part["frames"][10];
  const auto displacement = values_of(frame["displacement"]);
  ASSERT_EQ(displacement.size(), 3u * 26u);
  for (std::size_t i = 0; i < displacement.size(); i += 3) {
    EXPECT_TRUE(near_abs(displacement[i], 0.01, 1e-6));
    EXPECT_TRUE(near_abs(displacement[i + 2], -0.02, 1e-6));
  }
  EXPECT_TRUE(near_abs(values_of(frame["speed"])[5], 5.0, 1e-3));
  EXPECT_TRUE(near_abs(values_of(frame["stress"])[5], 1e4, 1.0));
  const auto& history = part["histories"][0];
  EXPECT_TRUE(near_abs(values_of(history[2])[7], -0.014, 1e-6));
  EXPECT_TRUE(near_abs(values_of(history[3])[7], 3.0, 1e-3));
  EXPECT_TRUE(near_abs(values_of(history[6])[7], 7e3, 1.0));
}

TEST(SceneOfARun, LeavesOutputsOutUntilItFits) {
  const tests::TemporaryFolder folder;
  write_stone(folder.file("qdem.h5"), 101);
  std::size_t n_before = 102;
  for (const std::size_t limit : {80000u, 30000u, 12000u}) {
    const auto scene = scene_json(folder.path(), limit);
    ASSERT_FALSE(scene.contains("note")) << scene["note"];
    EXPECT_LE(script_text(scene).size(), limit);
    const auto frames = scene["frames"];
    EXPECT_LT(frames.size(), n_before);
    EXPECT_EQ(frames.front(), 0.0);
    EXPECT_TRUE(near_abs(frames.back().get<double>(), 0.1, 1e-12));
    EXPECT_EQ(scene["parts"][0]["frames"].size(), frames.size());
    n_before = frames.size();
  }
  EXPECT_TRUE(scene_json(folder.path(), 2000).contains("note")) << "not even two frames";
  const tests::TemporaryFolder empty;
  EXPECT_TRUE(scene_json(empty.path(), 1000000).contains("note"));
}

TEST(TablesInAPage, ThinnedToTheLargestOfABlock) {
  coupler::study::Table table{"t", {}};
  table.add("time", "s", {0, 1, 2, 3, 4}), table.add("force", "N", {1, -9, 2, 3, -4});
  const auto whole = table_json(table, 5), thin = table_json(table, 3);
  EXPECT_EQ(whole["block"], 1);
  EXPECT_EQ(thin["block"], 2);
  EXPECT_EQ(thin["rows"], 5);
  EXPECT_EQ(numbers_of<float>(whole["columns"][1]["f32"]), (std::vector<float>{1, -9, 2, 3, -4}));
  EXPECT_EQ(numbers_of<float>(thin["columns"][0]["f32"]), (std::vector<float>{0, 2, 4}));
  EXPECT_EQ(numbers_of<float>(thin["columns"][1]["f32"]), (std::vector<float>{-9, 3, -4}));
}

TEST(FactsOfARun, WordsOfItsCaseAndWarningsOfItsLogs) {
  EXPECT_EQ(leading_comment("#:schema x.json\n# A wheel\n#\n# rolls.\n\n# not this\nkey = 1\n"), "A wheel rolls.");
  EXPECT_EQ(leading_comment("key = 1\n"), "");
  EXPECT_EQ(warnings_of("a info b\nc warning d\ne error f\ng error h\n", 2),
            (std::vector<std::string>{"c warning d", "e error f", "... and 1 more lines"}));
}

}  // namespace
