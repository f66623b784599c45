// One message of every type with no value left at its default, and equality of messages.
#pragma once

#include <tuple>
#include <variant>
#include <vector>

#include "proto/wire/messages.hpp"

namespace proto {

inline auto tied(const Field& m) {
  return std::tie(m.name, m.values);
}
inline auto tied(const Fact& m) {
  return std::tie(m.key, m.number, m.text);
}
inline auto tied(const Capabilities& m) {
  return std::tie(m.robin, m.rollback, m.save_restore, m.initialise);
}
inline auto tied(const FieldSpec& m) {
  return std::tie(m.name, m.unit, m.components, m.outgoing);
}
inline auto tied(const SeatRegistration& m) {
  return std::tie(m.name, m.points, m.weights, m.rigid_response, m.force_resultants, m.stiffness, m.damping, m.preload,
                  m.tension_cutoff, m.own_points);
}
inline auto tied(const FieldSet& m) {
  return std::tie(m.all());
}
inline auto tied(const Hello& m) {
  return std::tie(m.name, m.protocol_major, m.protocol_minor, m.schema_hash, m.case_hash, m.session_token, m.build_id,
                  m.capabilities);
}
inline auto tied(const Welcome& m) {
  return std::tie(m.session, m.heartbeat_s);
}
inline auto tied(const Reject& m) {
  return std::tie(m.reason);
}
inline auto tied(const Interface& m) {
  return std::tie(m.fields, m.seats);
}
inline auto tied(const Configure& m) {
  return std::tie(m.window_s, m.windows, m.mode, m.output_directory, m.stiffness, m.damping, m.preload,
                  m.tension_cutoff, m.pad_map);
}
inline auto tied(const Configured& m) {
  return std::tie(m.largest_step_s, m.facts, m.largest_initialise_step_s);
}
inline auto tied(const Start&) {
  return std::tuple<>();
}
inline auto tied(const Advance& m) {
  return std::tie(m.phase, m.window, m.iteration, m.window_s, m.sub_cycles, m.data);
}
inline auto tied(const Result& m) {
  return std::tie(m.phase, m.window, m.iteration, m.compute_s, m.data, m.residual, m.largest_step_s);
}
inline auto tied(const Commit& m) {
  return std::tie(m.window);
}
inline auto tied(const Rollback& m) {
  return std::tie(m.window);
}
inline auto tied(const Save& m) {
  return std::tie(m.window, m.path);
}
inline auto tied(const Saved& m) {
  return std::tie(m.window, m.hash);
}
inline auto tied(const Restore& m) {
  return std::tie(m.window, m.path, m.hash);
}
inline auto tied(const Restored& m) {
  return std::tie(m.window);
}
inline auto tied(const Heartbeat& m) {
  return std::tie(m.window, m.progress);
}
inline auto tied(const Fault& m) {
  return std::tie(m.code, m.text);
}
inline auto tied(const Finish&) {
  return std::tuple<>();
}
inline auto tied(const Bye& m) {
  return std::tie(m.facts);
}
inline auto tied(const Message& m) {
  return std::tie(m.session, m.sequence, m.in_reply_to, m.body);
}

/// Equality of every type above, found by argument-dependent look-up.
template <class T, class = decltype(tied(std::declval<const T&>()))>
bool operator==(const T& a, const T& b) {
  return tied(a) == tied(b);
}

}  // namespace proto

namespace tests {

inline std::vector<proto::Message> sample_messages() {
  using namespace proto;
  FieldSet data;
  data.set(field::impulse, {1.0, -2.5, 3.0e-300});
  data.set(field::pad_work, {4.0, 5.0, -0.1});
  const std::vector<Fact> facts = {{"bed.porosity", 0.41, ""}, {"bed.mesher", {}, "gmsh"}};
  const SeatRegistration seat{"seat", {1, 2, 3}, {1},       {4, 5, 6},          {7, 8, 9},
                              {1e6},  {1e3},     {20000.0}, {true, false, true}, true};
  const std::vector<Body> bodies = {
      Hello{"qdem", 1, 2, 3, 4, "token", "build", {true, false, true, true}},
      Welcome{77, 0.5},
      Reject{"the name is taken"},
      Interface{{{"impulse", "N s", 3, true}, {"rail_displacement", "m", 3, false}}, {seat, seat}},
      Configure{5e-5, 1600, LoadMode::prescribed_force, "runs/x", {1.0}, {2.0}, {3.0}, {true, false}, {0.5, 0.25}},
      Configured{1e-6, facts},
      Configured{},
      Start{},
      Advance{Phase::march, 12, 3, 5e-5, 50, data},
      Result{Phase::march, -1, 3, 0.25, data, {}},
      Result{Phase::initialise, 5, 1, 0.5, data, 4e-3},
      Commit{12},
      Rollback{13},
      Save{14, "a/b"},
      Saved{15, 0xfedcba9876543210u},
      Restore{16, "a/b", 99},
      Restored{17},
      Heartbeat{18, 123456789012u},
      Fault{75, "the solution is not finite"},
      Finish{},
      Bye{facts},
  };
  std::vector<Message> messages;
  for (const auto& body : bodies) messages.push_back({0x1122334455667788u, 1000 + messages.size(), 41, body});
  return messages;
}

}  // namespace tests
