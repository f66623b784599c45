#include "coupler/record/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "proto/result/provenance.hpp"

namespace coupler {
namespace {

using Json = nlohmann::ordered_json;

Json value_of(const proto::Fact& fact) {
  if (!fact.number) return fact.text;
  const double number = *fact.number;
  if (number == std::floor(number) && std::abs(number) < 9e15) return static_cast<std::int64_t>(number);
  return number;
}

/// Puts a fact under its dotted key. A key that is taken, or leads through a value, goes whole into "facts".
void put_fact(Json& root, const proto::Fact& fact) {
  Json* place = &root;
  std::size_t first = 0;
  for (std::size_t dot; (dot = fact.key.find('.', first)) != std::string::npos; first = dot + 1) {
    Json& next = (*place)[fact.key.substr(first, dot - first)];
    if (!next.is_null() && !next.is_object()) {
      root["facts"][fact.key] = value_of(fact);
      return;
    }
    place = &next;
  }
  const auto last = fact.key.substr(first);
  if (place->contains(last))
    root["facts"][fact.key] = value_of(fact);
  else
    (*place)[last] = value_of(fact);
}

Json seat_list(const std::vector<SeatFigures>& seats) {
  Json list = Json::array();
  for (const auto& seat : seats)
    list.push_back({{"name", seat.name},
                    {"max_force_n", seat.max_force_n},
                    {"max_rail_displacement_m", seat.max_rail_displacement_m},
                    {"max_sleeper_displacement_m", seat.max_sleeper_displacement_m}});
  return list;
}

}  // namespace

std::string summary_text(const Summary& s) {
  Json root;
  root["status"] = s.status;
  root["case"] = {{"name", s.case_name}, {"hash", s.case_hash}};
  root["version"] = proto::project_version();
  root["scheme"] = s.scheme;
  root["windows"] = s.n_windows;
  root["windows_wanted"] = s.n_windows_wanted;
  root["window_s"] = s.window_s;
  root["sub_cycles"] = s.sub_cycles;
  root["initialise"] = {{"windows", s.initialise_windows},
                        {"change_relative", s.rest.change},
                        {"qdem_residual", s.rest.qdem_residual},
                        {"fem_residual", s.rest.fem_residual}};
  root["interface"] = {{"energy_defect_relative", s.energy_defect_relative},
                       {"momentum_defect_relative", s.momentum_defect_relative},
                       {"moment_defect_relative", s.moment_defect_relative},
                       {"hash", fmt::format("{:016x}", s.interface_hash)}};
  root["observed"] = {{"passes_mean", s.observation.mean_solves()},
                      {"passes_most", s.observation.state().most_solves},
                      {"windows_not_converged", s.observation.state().n_unconverged},
                      {"contraction", s.observation.contraction()},
                      {"growth_per_window", s.observation.growth()},
                      {"pad_law_deviation", s.observation.law_deviation()}};
  if (!s.switched_to.empty()) root["switched_to"] = s.switched_to;
  root["warnings"] = s.warnings;
  if (s.checkpoint_window >= 0) root["checkpoint"] = {{"window", s.checkpoint_window}};
  root["resumed"] = s.resumed;
  root["wall_s"] = {{"total", s.wall.total}, {"start_up", s.wall.start_up}, {"qdem", s.wall.qdem},
                    {"fem", s.wall.fem},     {"coupler", s.wall.coupler},   {"waiting", s.wall.waiting}};
  root["rail_seats"] = seat_list(s.seats);
  if (s.status != "ok")
    root["failure"] = {
        {"message", s.failure.message}, {"culprit", s.failure.culprit}, {"exit_code", s.failure.exit_code}};
  for (const auto& fact : s.facts) put_fact(root, fact);
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace coupler
