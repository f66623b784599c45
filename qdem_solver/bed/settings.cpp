#include "qdem_solver/bed/settings.hpp"

#include <algorithm>
#include <optional>

#include "proto/error.hpp"
#include "qdem_solver/bed/stone_files.hpp"

namespace qdem::bed {
namespace {

using proto::Range;
using proto::Section;

constexpr Range share{0.0, 1.0};

ShapeRange read_range(const Section& bed, const std::string& key, const std::vector<double>& fallback, Range range) {
  const auto values = bed.numbers_or(key, fallback, range);
  if (values.size() != 2 || values[0] > values[1]) bed.fail(key, "a range is two numbers, the lower first");
  return {values[0], values[1]};
}

Gradation read_gradation(const Section& bed) {
  Gradation gradation;
  gradation.sizes = bed.numbers_or("sieve_sizes_m", {0.045, 0.056, 0.063, 0.071, 0.080}, Range::positive());
  gradation.passing = bed.numbers_or("sieve_passing_percent", {0, 25, 55, 85, 100}, Range::between(0, 100));
  const auto n = gradation.sizes.size();
  if (n < 2) bed.fail("sieve_sizes_m", "a gradation needs two sieves or more");
  if (gradation.passing.size() != n) {
    bed.fail("sieve_passing_percent", "as many shares as sieves are needed, " + std::to_string(n));
  }
  for (double& passing : gradation.passing) passing /= 100;
  for (std::size_t i = 1; i < n; ++i) {
    if (!(gradation.sizes[i] > gradation.sizes[i - 1])) bed.fail("sieve_sizes_m", "sieves must ascend");
    if (gradation.passing[i] < gradation.passing[i - 1]) bed.fail("sieve_passing_percent", "shares must not descend");
  }
  if (gradation.passing.front() != 0 || gradation.passing.back() != 1) {
    bed.fail("sieve_passing_percent", "the smallest sieve must pass 0 and the largest 100");
  }
  return gradation;
}

/// Stones from files have the shapes they have, and their number.
void read_stone_files(const Section& bed, StoneShapes& shapes) {
  for (const char* key : {"templates", "elongation", "flatness"}) {
    if (bed.has(key))
      bed.fail(key, "it is for generated stones, and stone_files gives stones", "remove one of the two");
  }
  shapes.files = bed.matching_files("stone_files", stone_file_endings);
  shapes.n_templates = static_cast<int>(shapes.files.size());
}

/// `names`: of all materials.
std::vector<Ingredient> read_mixture(const Section& bed, const std::vector<std::string>& names) {
  std::vector<Ingredient> mixture;
  for (const std::string& name : bed.texts_or("stone_materials", {"stone"})) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      const std::string nearest = proto::nearest_name(name, names);
      bed.fail("stone_materials", "there is no material '" + name + "'",
               nearest.empty() ? "add a [[qdem.material]] with that name" : "did you mean '" + nearest + "'?");
    }
    mixture.push_back({static_cast<int>(found - names.begin()), 1.0});
  }
  if (mixture.empty()) bed.fail("stone_materials", "stones need a material");
  const auto shares =
      bed.numbers_or("stone_material_shares", std::vector<double>(mixture.size(), 1.0), Range::positive());
  if (shares.size() != mixture.size()) {
    bed.fail("stone_material_shares", "as many shares as materials are needed, " + std::to_string(mixture.size()));
  }
  for (std::size_t i = 0; i < shares.size(); ++i) mixture[i].share = shares[i];
  return mixture;
}

StoneShapes read_shapes(const Section& bed, std::uint64_t seed) {
  StoneShapes shapes;
  shapes.seed = seed;
  shapes.n_templates = static_cast<int>(bed.integer_or("templates", 24, Range::between(1, 200)));
  shapes.elongation = read_range(bed, "elongation", {1.1, 1.7}, Range::between(1, 3));
  shapes.flatness = read_range(bed, "flatness", {0.55, 0.95}, Range::between(0.3, 1));
  const auto tets = read_range(bed, "elements_per_stone", {50, 100}, Range::between(20, 2000));
  shapes.least_tets = static_cast<int>(tets.lowest), shapes.most_tets = static_cast<int>(tets.highest);
  if (bed.has("stone_files")) read_stone_files(bed, shapes);
  return shapes;
}

/// Height, bottom width, top width; of `known` where there is one and the key is not given.
SleeperSection read_section(const Section& bed, const std::string& key, const SleeperSection* known) {
  if (known != nullptr && !bed.has(key)) return *known;
  const auto values = bed.numbers(key, 3, Range::positive());
  if (values[2] > values[1]) bed.fail(key, "the top is wider than the bottom", "give height, bottom width, top width");
  return {0.0, values[0], values[1], values[2]};
}

SleeperShape read_tapered(const Section& bed, const std::optional<SleeperShape>& known) {
  const SleeperSection* of_known = known ? known->sections.data() : nullptr;
  const auto section = [&](const char* key, int i) { return read_section(bed, key, known ? of_known + i : nullptr); };
  const SleeperSection centre = section("sleeper_centre_m", 0), seat = section("sleeper_seat_m", 1),
                       end = section("sleeper_end_m", 3);
  for (const auto& [key, height] : {std::pair("sleeper_centre_m", centre.height), {"sleeper_end_m", end.height}}) {
    if (height > seat.height) bed.fail(key, "it is higher than the rail seat", "lower it: the seat is the top, z = 0");
  }
  const bool own_length = !known || bed.has("sleeper_length_m"), own_range = !known || bed.has("sleeper_seat_range_m");
  const double length = own_length ? bed.number("sleeper_length_m", Range::positive()) : 2 * known->half_length();
  std::pair<double, double> range;
  if (own_range) {
    const auto values = bed.numbers("sleeper_seat_range_m", 2, Range::positive());
    range = {values[0], values[1]};
  } else {
    range = known->seat_range();
  }
  if (!(range.first < range.second && range.second < length / 2)) {
    bed.fail(own_range ? "sleeper_seat_range_m" : "sleeper_length_m",
             "the rail seat must begin before it ends, and end before the sleeper does",
             "places are distances from the track's centre");
  }
  return tapered_sleeper(length, range, centre, seat, end);
}

void refuse_keys(const Section& bed, const std::vector<const char*>& keys, const std::string& problem) {
  for (const char* key : keys) {
    if (bed.has(key)) bed.fail(key, problem, "remove it");
  }
}

SleeperShape read_sleeper(const Section& bed) {
  const std::string name = bed.choice_or("sleeper", "box", {"box", "tapered", "3PR", "B70"});
  if (name != "box") {
    refuse_keys(bed, {"sleeper_width_m", "sleeper_height_m"}, "it is for a box, and the sleeper is \"" + name + "\"");
    return read_tapered(bed, name == "tapered" ? std::nullopt : std::optional(known_sleeper(name)));
  }
  refuse_keys(bed, {"sleeper_centre_m", "sleeper_seat_m", "sleeper_end_m", "sleeper_seat_range_m"},
              "it is for a tapered sleeper, and the sleeper is a box");
  const double length = bed.number_or("sleeper_length_m", 2.4, Range::positive());
  const double width = bed.number_or("sleeper_width_m", 0.26, Range::positive());
  return box_sleeper(length, width, bed.number_or("sleeper_height_m", 0.2, Range::positive()));
}

/// A sleeper alone would fall.
Scene read_scene(const proto::CaseFile& file) {
  const Section bed = file.section("bed");
  const std::string name = bed.choice_or("scene", "ballast", {"ballast", "sleeper", "stone"});
  if (name == "ballast") return Scene::ballast;
  if (name == "stone") return Scene::stone;
  if (file.section("qdem").number_or("gravity_m_per_s2", 9.81, Range::not_negative()) > 0) {
    bed.fail("scene", "nothing carries the sleeper", "set [qdem] gravity_m_per_s2 = 0");
  }
  return Scene::sleeper;
}

void read_geometry(const Section& bed, Settings& s) {
  s.sleeper = read_sleeper(bed);
  s.sleeper_cells = static_cast<int>(bed.integer_or("sleeper_cells_through_height", 4, Range::between(1, 20)));
  s.depth = bed.number_or("depth_m", 0.2, Range::positive());
  s.crib_height = bed.number_or("crib_height_m", 0.15, Range::not_negative());
  s.shoulder_width = bed.number_or("shoulder_width_m", 0.2, Range::not_negative());
  s.shoulder_slope = bed.number_or("shoulder_slope", 1.5, Range::between(0, 4));
  if (s.crib_height > s.sleeper.height()) {
    bed.fail("crib_height_m", "the crib would bury the sleeper, whose height is " + std::to_string(s.sleeper.height()));
  }
}

void read_procedure(const Section& bed, Settings& s) {
  const std::string law = bed.choice_or("poured_with", "", {"quadruple", "bond"});
  if (!law.empty()) s.poured_with = law == "bond" ? Interaction::bond : Interaction::quadruple;
  s.target_porosity = bed.number_or("target_porosity", 0.41, Range::between(0.3, 0.6));
  s.pour_speed = bed.number_or("pour_speed_m_per_s", 1.5, Range::between(0.1, 5));
  s.pour_young = bed.number_or("pour_young_pa", 1e8, Range::positive());
  s.pour_stiffness = bed.number_or("pour_stiffness_n_per_m", 1e5, Range::positive());
  s.pour_friction = bed.number_or("pour_friction", 0.1, Range::not_negative());
  s.pour_swelling = bed.number_or("pour_swelling", 0.02, Range::between(0, 0.1));
  s.ramp_levels = static_cast<int>(bed.integer_or("ramp_levels", 8, Range::between(1, 50)));
  s.ramp_steps = static_cast<int>(bed.integer_or("ramp_steps", 300, Range::between(10, 1e6)));
  s.preload = bed.number_or("preload_n", 40e3, Range::not_negative());
  s.preload_cycles = static_cast<int>(bed.integer_or("preload_cycles", 2, Range::between(0, 1e4)));
  s.preload_steps = static_cast<int>(bed.integer_or("preload_steps", 2500, Range::between(10, 1e6)));
  s.rest_steps = static_cast<int>(bed.integer_or("rest_steps", 100000, Range::between(10, 1e7)));
}

void read_limits(const Section& bed, Settings& s) {
  const auto porosity = read_range(bed, "porosity_limits", {0.38, 0.45}, share);
  s.porosity_lowest = porosity.lowest, s.porosity_highest = porosity.highest;
  s.unbalanced_limit = bed.number_or("unbalanced_limit", 1e-5, Range::positive());
  s.kinetic_limit = bed.number_or("kinetic_energy_limit_j", 1e-6, Range::positive());
  s.penetration_limit = bed.number_or("penetration_limit_m", 0, Range::not_negative());
  s.tilt_limit = bed.number_or("sleeper_tilt_limit_rad", 5e-3, Range::positive());
}

/// A pad lies on the plane part of the top.
void check_pad(const Section& bed, const SleeperShape& sleeper, const proto::RailSeat& seat) {
  const auto [first, last] = sleeper.seat_range();
  const double y = std::abs(seat.origin[1]), half = seat.half_lengths[1];
  if (y - half < first || y + half > last) {
    bed.fail("sleeper_seat_range_m",
             "rail seat '" + seat.name + "' reaches from " + std::to_string(y - half) + " to " +
                 std::to_string(y + half) + " m, the sleeper's plane top from " + std::to_string(first) + " to " +
                 std::to_string(last) + " m",
             "move one of the two");
  }
  for (const auto& section : sleeper.sections) {
    if (section.place == first && seat.half_lengths[0] > section.top_width / 2) {
      bed.fail("sleeper_seat_m", "rail seat '" + seat.name + "' is wider than the sleeper's top");
    }
  }
}

void check_seats(const Section& bed, const Settings& s) {
  for (const auto& seat : s.seats) {
    if (s.sleeper.is_tapered()) {
      check_pad(bed, s.sleeper, seat);
      continue;
    }
    const double y = std::abs(seat.origin[1]);
    if (y + seat.half_lengths[1] > s.half_length()) {
      bed.fail("sleeper_length_m", "rail seat '" + seat.name + "' ends " +
                                       std::to_string(y + seat.half_lengths[1] - s.half_length()) +
                                       " m beyond the end of the sleeper");
    }
    if (seat.half_lengths[0] > s.sleeper.width() / 2) {
      bed.fail("sleeper_width_m", "rail seat '" + seat.name + "' is wider than the sleeper");
    }
  }
  if (s.sleeper.width() >= s.spacing) {
    bed.fail(s.sleeper.is_tapered() ? "sleeper_seat_m" : "sleeper_width_m", "the sleeper fills the bay");
  }
}

}  // namespace

std::vector<std::string> material_names(const proto::CaseFile& file) {
  std::vector<std::string> names{"stone", "sleeper"};
  for (const Section& material : file.section("qdem").sections("material")) {
    const std::string name = material.text_or("name", "");
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

Settings read_settings(const proto::CaseFile& file) {
  const Section bed = file.section("bed"), track = file.section("track");
  Settings s;
  s.scene = read_scene(file);
  s.seed = static_cast<std::uint64_t>(bed.integer_or("seed", 1, Range::between(0, 1e9)));
  s.spacing = track.number("sleeper_spacing_m", Range::positive());
  s.seats = proto::read_rail_seats(file);
  read_geometry(bed, s);
  s.gradation = read_gradation(bed);
  s.shapes = read_shapes(bed, s.seed);
  s.mixture = read_mixture(bed, material_names(file));
  read_procedure(bed, s);
  read_limits(bed, s);
  bed.finish();
  check_seats(bed, s);
  return s;
}

}  // namespace qdem::bed
