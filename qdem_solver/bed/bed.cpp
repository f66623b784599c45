#include "qdem_solver/bed/bed.hpp"

#include <spdlog/spdlog.h>
#include <xxhash.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/bed/builder.hpp"
#include "qdem_solver/bed/settings.hpp"
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
                             s.sleeper_length,
                             s.sleeper_width,
                             s.sleeper_height,
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
}

void add_physics(InputHash& hash, const BedPhysics& p) {
  for (const Material* m : {&p.stone, &p.sleeper}) {
    for (const double value : {m->young, m->poisson, m->density, m->lame_viscosity, m->shear_viscosity})
      hash.add(value);
  }
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

std::string hash_of(const bed::Settings& settings, const BedPhysics& physics) {
  InputHash hash;
  add_settings(hash, settings);
  add_physics(hash, physics);
  add_stone_files(hash, settings.shapes.files);
  return hash.hex();
}

}  // namespace

std::string bed_hash(const proto::CaseFile& file, const BedPhysics& physics) {
  return hash_of(bed::read_settings(file), physics);
}

Bed make_bed(const proto::CaseFile& file, const BedPhysics& physics, const std::string& cache_folder) {
  const bed::Settings settings = bed::read_settings(file);
  const std::string hash = hash_of(settings, physics);
  const auto folder = cache_of(cache_folder);
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
  Bed bed = bed::Builder(settings, physics).build();
  bed.report.hash = hash;
  write_bed_file(path.string(), bed);
  spdlog::info("bed: stored as {}", path.string());
  return bed;
}

void check_bed(const proto::CaseFile& file) {
  bed::read_settings(file);
}

}  // namespace qdem
