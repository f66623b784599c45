#include "qdem_solver/bed/bed.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <xxhash.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/bed/builder.hpp"
#include "qdem_solver/bed/lone_body.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "qdem_solver/output/bed_file.hpp"

namespace qdem {
namespace {

/// Collects the bytes of a bed's inputs.
class InputHash {
 public:
  void add(double value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void add(const Eigen::Vector3d& v) { add(v[0]), add(v[1]), add(v[2]); }
  void add(const std::vector<double>& values) {
    add(static_cast<double>(values.size()));
    for (const double value : values) add(value);
  }
  void add(const std::string& text) {
    add(static_cast<double>(text.size()));
    bytes_ += text;
  }
  std::string hex() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx",
                  static_cast<unsigned long long>(XXH3_64bits(bytes_.data(), bytes_.size())));
    return text;
  }

 private:
  std::string bytes_;
};

void add_settings(InputHash& hash, const bed::Settings& s) {
  for (const double value : {static_cast<double>(bed_file_format),
                             static_cast<double>(s.seed),
                             2 * s.sleeper.half_length(),
                             s.sleeper.width(),
                             s.sleeper.height(),
                             static_cast<double>(s.sleeper_cells),
                             s.depth,
                             s.crib_height,
                             s.shoulder_width,
                             s.shoulder_slope,
                             static_cast<double>(s.shapes.n_templates),
                             s.shapes.elongation.lowest,
                             s.shapes.elongation.highest,
                             s.shapes.flatness.lowest,
                             s.shapes.flatness.highest,
                             static_cast<double>(s.shapes.least_tets),
                             static_cast<double>(s.shapes.most_tets),
                             s.target_porosity,
                             s.pour_speed,
                             s.pour_young,
                             s.pour_stiffness,
                             s.pour_friction,
                             s.pour_swelling,
                             static_cast<double>(s.ramp_levels),
                             static_cast<double>(s.ramp_steps),
                             s.preload,
                             static_cast<double>(s.preload_cycles),
                             static_cast<double>(s.preload_steps),
                             static_cast<double>(s.rest_steps),
                             s.porosity_lowest,
                             s.porosity_highest,
                             s.unbalanced_limit,
                             s.kinetic_limit,
                             s.penetration_limit,
                             s.tilt_limit,
                             s.spacing}) {
    hash.add(value);
  }
  hash.add(s.gradation.sizes), hash.add(s.gradation.passing);
  for (const auto& seat : s.seats) hash.add(seat.origin);
  if (!s.sleeper.is_tapered()) return;
  for (const auto& section : s.sleeper.sections) {
    for (const double value : {section.place, section.height, section.bottom_width, section.top_width}) hash.add(value);
  }
}

void add_material(InputHash& hash, const Material& m) {
  for (const double value : {m.young, m.poisson, m.density, m.lame_viscosity, m.shear_viscosity}) hash.add(value);
}

void add_physics(InputHash& hash, const BedPhysics& p) {
  add_material(hash, p.stone), add_material(hash, p.sleeper);
  const ContactLaw& c = p.contact;
  for (const double value : {c.normal_stiffness, c.tangential_ratio, c.damping_ratio, c.friction, c.rounding, c.skin}) {
    hash.add(value);
  }
  hash.add(p.ground_friction);
  hash.add(p.gravity);
  if (c.shape == ContactShape::sphere) {
    hash.add(std::string("sphere"));
    hash.add(static_cast<double>(c.radii)), hash.add(c.rolling_friction);
  }
  hash.add(static_cast<double>(p.stone.interaction)), hash.add(static_cast<double>(p.sleeper.interaction));
}

bool is_poured_otherwise(const bed::Settings& settings, const BedPhysics& physics) {
  return settings.poured_with && *settings.poured_with != physics.stone.interaction;
}

/// Rigid ones add nothing.
void add_bearings(InputHash& hash, const BedPhysics& p) {
  if (p.lining.is_rigid() && p.ground.is_rigid()) return;
  for (const Bearing* b : {&p.lining, &p.ground}) {
    for (const double value : {b->normal_stiffness, b->tangential_stiffness, b->normal_damping, b->tangential_damping})
      hash.add(value);
  }
}

/// A bed of the material "stone" alone adds nothing.
void add_mixture(InputHash& hash, const std::vector<bed::Ingredient>& mixture, const BedPhysics& p) {
  if (mixture.size() == 1 && mixture[0].material_id == 0) return;
  const auto materials = p.materials();
  for (const bed::Ingredient& part : mixture) {
    hash.add(static_cast<double>(part.material_id));
    hash.add(part.share);
    add_material(hash, materials.at(part.material_id));
  }
}

/// Names and content. A bed of generated stones adds nothing.
void add_stone_files(InputHash& hash, const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream content;
    content << in.rdbuf();
    if (!in)
      throw proto::Error(proto::ExitCode::missing_input, "the stone file cannot be read", path,
                         "check its permissions");
    hash.add(std::filesystem::path(path).filename().string());
    hash.add(content.str());
  }
}

std::filesystem::path cache_of(const std::string& wanted) {
  if (!wanted.empty()) return wanted;
  if (const char* own = std::getenv("QDEM_BED_CACHE"); own != nullptr && *own != '\0') return own;
  if (const char* home = std::getenv("XDG_CACHE_HOME"); home != nullptr && *home != '\0') {
    return std::filesystem::path(home) / "qdem_fem" / "beds";
  }
  return std::filesystem::path(".cache") / "beds";
}

/// Rigid ground adds nothing.
void add_subgrade(InputHash& hash, const std::optional<SubgradeLayer>& layer) {
  if (!layer) return;
  add_material(hash, layer->material);
  for (const double value :
       {layer->thickness, layer->width, layer->element, layer->normal_stiffness, layer->tangential_stiffness}) {
    hash.add(value);
  }
}

/// A bed that the law of the run has built adds nothing.
void add_pouring_law(InputHash& hash, const bed::Settings& s, const BedPhysics& p) {
  if (!is_poured_otherwise(s, p)) return;
  hash.add(std::string("poured with"));
  hash.add(static_cast<double>(*s.poured_with));
}

/// A bed of ballast adds nothing.
void add_scene(InputHash& hash, bed::Scene scene) {
  if (scene != bed::Scene::ballast) hash.add(static_cast<double>(scene));
}

std::string hash_of(const bed::Settings& settings, const BedPhysics& physics) {
  InputHash hash;
  add_settings(hash, settings);
  add_physics(hash, physics);
  add_stone_files(hash, settings.shapes.files);
  add_mixture(hash, settings.mixture, physics);
  add_bearings(hash, physics);
  add_subgrade(hash, physics.subgrade);
  add_pouring_law(hash, settings, physics);
  add_scene(hash, settings.scene);
  return hash.hex();
}

bed::Settings checked_settings(const proto::CaseFile& file, const BedPhysics& physics) {
  bed::Settings settings = bed::read_settings(file);
  if (physics.subgrade && physics.subgrade->width < settings.wall()) {
    file.section("qdem")
        .section("subgrade")
        .fail("width_m",
              fmt::format("the layer ends {:.4g} m from the track's centre, under a bed whose slope ends at {:.4g} m",
                          physics.subgrade->width, settings.wall()),
              "make it wider, best by its thickness");
  }
  return settings;
}

Bed cached_bed(const bed::Settings& settings, const BedPhysics& physics, const std::filesystem::path& folder);

/// A bed on a subgrade of elements comes from that on rigid ground, one for another law from that which it is poured
/// with.
Bed built_bed(const bed::Settings& settings, const BedPhysics& physics, const std::filesystem::path& folder) {
  bed::Builder builder(settings, physics);
  BedPhysics before = physics;
  if (physics.subgrade) {
    before.subgrade.reset();
    return builder.lay_on_subgrade(cached_bed(settings, before, folder));
  }
  if (!is_poured_otherwise(settings, physics)) return builder.build();
  before.stone.interaction = before.sleeper.interaction = *settings.poured_with;
  for (Material& material : before.others) material.interaction = *settings.poured_with;
  return builder.rest_anew(cached_bed(settings, before, folder));
}

/// From `folder`, or built and stored there.
Bed cached_bed(const bed::Settings& settings, const BedPhysics& physics, const std::filesystem::path& folder) {
  const std::string hash = hash_of(settings, physics);
  const auto path = folder / (hash + ".h5");
  if (std::filesystem::exists(path)) {
    Bed bed = read_bed_file(path.string(), physics);
    bed.report.from_cache = true;
    spdlog::info("bed: loaded from {}", path.string());
    return bed;
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw proto::Error(proto::ExitCode::cannot_create, "the bed cache cannot be made: " + error.message(),
                       folder.string(), "set QDEM_BED_CACHE to a folder you can write");
  }
  Bed bed = built_bed(settings, physics, folder);
  bed.report.hash = hash;
  write_bed_file(path.string(), bed);
  spdlog::info("bed: stored as {}", path.string());
  return bed;
}

}  // namespace

std::string bed_hash(const proto::CaseFile& file, const BedPhysics& physics) {
  return hash_of(checked_settings(file, physics), physics);
}

Bed make_bed(const proto::CaseFile& file, const BedPhysics& physics, const std::string& cache_folder) {
  const bed::Settings settings = checked_settings(file, physics);
  if (settings.scene == bed::Scene::ballast) return cached_bed(settings, physics, cache_of(cache_folder));
  Bed bed = bed::lone_body(settings, physics);
  bed.report.hash = hash_of(settings, physics);
  return bed;
}

SleeperFigures sleeper_figures(const proto::CaseFile& file, const BedPhysics& physics) {
  const bed::Settings settings = bed::read_settings(file);
  Model model;
  model.materials = {physics.sleeper};
  model.templates.push_back(bed::sleeper_mesh("sleeper", settings.sleeper, settings.sleeper_cells));
  model.bodies.resize(1);
  make_batches(model);
  return {2 * model.body_mass(0), largest_stable_step(element_rates(model).front())};
}

std::vector<std::string> check_bed(const proto::CaseFile& file, const BedPhysics& physics) {
  checked_settings(file, physics);
  const std::string coarse = physics.subgrade ? too_coarse(*physics.subgrade) : "";
  if (coarse.empty()) return {};
  return {coarse};
}

}  // namespace qdem
