#include "qdem_solver/participant/load_settings.hpp"

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace qdem {
namespace {

using proto::Range;
using proto::Section;
using History = std::function<double(double)>;

/// Keys of a history end with the unit of what it holds: "force_n", "displacement_m".
History read_table(const Section& section, const std::string& key) {
  const auto time = section.numbers("time_s", 0, Range::not_negative());
  const auto values = section.numbers(key);
  if (time.size() != values.size() || time.empty()) {
    section.fail(key, std::to_string(values.size()) + " values for " + std::to_string(time.size()) + " times",
                 "give as many as time_s has times");
  }
  if (std::adjacent_find(time.begin(), time.end(), std::greater_equal<>()) != time.end()) {
    section.fail("time_s", "the times do not ascend");
  }
  return [time, values](double t) {
    const auto next = std::upper_bound(time.begin(), time.end(), t) - time.begin();
    if (next == 0) return values.front();
    if (next == static_cast<std::ptrdiff_t>(time.size())) return values.back();
    const double share = (t - time[next - 1]) / (time[next] - time[next - 1]);
    return values[next - 1] + share * (values[next] - values[next - 1]);
  };
}

History read_half_sine(const Section& section) {
  const double peak = section.number("peak_n"), duration = section.number("duration_s", Range::positive());
  const double start = section.number_or("start_s", 0.0, Range::not_negative());
  return [=](double t) {
    const double share = (t - start) / duration;
    return share > 0 && share < 1 ? peak * std::sin(M_PI * share) : 0.0;
  };
}

History read_sine(const Section& section, const std::string& unit) {
  const double mean = section.number("mean_" + unit), amplitude = section.number("amplitude_" + unit);
  const double frequency = section.number("frequency_hz", Range::positive());
  const double cycles = section.number("cycles", Range::positive());
  const double start = section.number_or("start_s", 0.0, Range::not_negative());
  return [=](double t) {
    if (t < start) return mean * t / start;
    const double phase = std::min((t - start) * frequency, cycles);
    return mean + amplitude * std::sin(2 * M_PI * phase);
  };
}

Eigen::Vector3d vector_of(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

double read_impact_speed(const Section& section, double gravity) {
  const bool height = section.has("drop_height_m"), speed = section.has("impact_velocity_m_per_s");
  if (height == speed) {
    section.fail(height ? "drop_height_m" : "impact_velocity_m_per_s",
                 height ? "the impact is given twice" : "the impact is missing",
                 "give drop_height_m or impact_velocity_m_per_s");
  }
  if (speed) return section.number("impact_velocity_m_per_s", Range::not_negative());
  return std::sqrt(2 * gravity * section.number("drop_height_m", Range::not_negative()));
}

void read_drop_weight(const Section& section, double gravity, PatchLoad& load) {
  load.kind = LoadKind::drop_weight;
  load.mass = section.number("mass_kg", Range::positive());
  load.speed = read_impact_speed(section, gravity);
  load.stiffness = section.number("stiffness_n_per_m", Range::positive());
  load.damping = section.number_or("damping_ns_per_m", 0.0, Range::not_negative());
  load.start = section.number_or("start_s", 0.0, Range::not_negative());
}

void read_patch(const Section& section, LoadSettings& settings) {
  settings.body = section.text_or("body", settings.body);
  settings.region.centre = vector_of(section.numbers("centre_m", 3));
  if (section.has("radius_m") == section.has("half_lengths_m")) {
    section.fail("radius_m", "the patch's size is missing or given twice", "give radius_m or half_lengths_m");
  }
  if (section.has("radius_m")) {
    settings.region.radius = section.number("radius_m", Range::positive());
  } else {
    settings.region.half_lengths = vector_of(section.numbers("half_lengths_m", 3, Range::positive()));
  }
  if (section.has("direction")) settings.direction = vector_of(section.numbers("direction", 3));
  if (!(settings.direction.norm() > 0)) section.fail("direction", "it has no length");
}

LoadSettings read_load(const Section& section, double gravity) {
  LoadSettings settings;
  settings.target = section.choice_or("on", "pads", {"pads", "patch"}) == "pads" ? LoadTarget::pads : LoadTarget::patch;
  if (settings.target == LoadTarget::patch) read_patch(section, settings);
  const std::string kind = section.choice(
      "kind", {"table", "half_sine", "cyclic", "displacement_table", "displacement_sine", "drop_weight"});
  PatchLoad& load = settings.load;
  if (kind == "table") load.history = read_table(section, "force_n");
  if (kind == "half_sine") load.history = read_half_sine(section);
  if (kind == "cyclic") load.history = read_sine(section, "n");
  if (kind == "drop_weight") read_drop_weight(section, gravity, load);
  if (kind == "displacement_table") load.history = read_table(section, "displacement_m");
  if (kind == "displacement_sine") load.history = read_sine(section, "m");
  if (kind.find("displacement") == 0) {
    load.kind = LoadKind::displacement;
    if (settings.target == LoadTarget::patch) load.stiffness = section.number("stiffness_n_per_m", Range::positive());
  }
  return settings;
}

bool moves_foot(const LoadSettings& settings) {
  return settings.target == LoadTarget::pads && settings.load.kind == LoadKind::displacement;
}

int body_named(const Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (const Body& body : model.bodies) names.push_back(body.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  const std::string nearest = proto::nearest_name(name, names);
  throw proto::Error(
      proto::ExitCode::bad_data, "a load is on a body that is not there", "body '" + name + "'",
      nearest.empty() ? "the sleeper is 'sleeper', stones are 'stone_NUMBER'" : "did you mean '" + nearest + "'?");
}

}  // namespace

std::vector<LoadSettings> read_loads(const Section& run, double gravity) {
  std::vector<LoadSettings> loads;
  int feet = 0, forces = 0;
  for (const Section& section : run.sections("load")) {
    loads.push_back(read_load(section, gravity));
    if (loads.back().target == LoadTarget::patch) continue;
    if (moves_foot(loads.back())) ++feet;
    if (loads.back().load.kind == LoadKind::force) ++forces;
    if (feet > 1 || (feet > 0 && forces > 0)) {
      section.fail("kind", "the pads have a displacement and another load",
                   "give the pads one displacement, or forces");
    }
  }
  return loads;
}

std::vector<PatchLoad> make_patch_loads(const Model& model, const State& state,
                                        const std::vector<LoadSettings>& settings) {
  std::vector<PatchLoad> loads;
  for (const LoadSettings& of_case : settings) {
    if (!acts_on_patch(of_case)) continue;
    const bool on_pads = of_case.target == LoadTarget::pads;
    loads.push_back(of_case.load);
    loads.back().patch =
        on_pads ? make_pad_patch(model)
                : make_patch(model, state, body_named(model, of_case.body), of_case.region, of_case.direction);
  }
  return loads;
}

}  // namespace qdem
