#include "proto/session/session.hpp"

#include <chrono>
#include <cmath>

#include "proto/clock.hpp"
#include "proto/wire/codec.hpp"

namespace proto {
namespace {

/// Length and entries of one seat's registration; the coupler judges the values.
void check_shape(const SeatRegistration& seat) {
  const std::size_t n = seat.weights.size();
  const bool pad_owner = !seat.stiffness.empty();
  const auto is_pad = [&](std::size_t size) { return size == (pad_owner ? 3 * n : 0); };
  const bool right = n > 0 && seat.points.size() == 3 * n && seat.rigid_response.size() == 18 * n &&
                     seat.force_resultants.size() == 18 * n && is_pad(seat.stiffness.size()) &&
                     is_pad(seat.damping.size()) && is_pad(seat.preload.size()) && is_pad(seat.tension_cutoff.size());
  if (!right)
    throw Error(ExitCode::internal, "the registration of rail seat '" + seat.name + "' has arrays of wrong length", "",
                "see 'Registration' in proto/README.md");
}

bool has_own_points(const Interface& registered) {
  for (const auto& seat : registered.seats)
    if (seat.own_points) return true;
  return false;
}

}  // namespace

Session::Session(Participant& participant, Progress& progress) : participant_(participant), progress_(progress) {
  participant_.watch(progress_);
}

Hello Session::hello(const SessionOptions& options) {
  Hello hello;
  hello.name = participant_.name();
  hello.capabilities = capabilities_ = participant_.capabilities();
  hello.protocol_major = protocol_major;
  hello.protocol_minor = protocol_minor;
  hello.schema_hash = schema_hash();
  hello.case_hash = options.case_hash;
  hello.session_token = options.session_token;
  hello.build_id = participant_.build_id();
  return hello;
}

std::optional<Body> Session::handle(const Body& request) {
  return std::visit([this](const auto& body) { return answer(body); }, request);
}

void Session::out_of_order(const char* name, const std::string& why) const {
  static constexpr const char* states[] = {"greeting", "registered", "configured", "marching", "advanced", "finished"};
  throw Error(ExitCode::protocol, std::string(name) + " is out of order: " + why,
              std::string("state ") + states[static_cast<int>(state_)] + ", window " + std::to_string(window_),
              "see 'Legal order' in proto/README.md");
}

void Session::require(bool condition, const char* name, const std::string& why) const {
  if (!condition) out_of_order(name, why);
}

template <class Other>
std::optional<Body> Session::answer(const Other& request) {
  out_of_order(name_of(request), "a participant does not take it");
}

std::optional<Body> Session::answer(const Welcome&) {
  require(state_ == State::greeting, "Welcome", "the session has begun already");
  interface_ = participant_.describe();
  n_values_ = 0;
  for (const auto& seat : interface_.seats) {
    check_shape(seat);
    n_values_ += seat.points.size();
  }
  state_ = State::registered;
  return interface_;
}

std::optional<Body> Session::answer(const Configure& request) {
  require(state_ == State::registered, "Configure", "it comes once, after the registration");
  require(request.window_s > 0.0 && request.windows > 0, "Configure", "window length and number must be positive");
  check_pad(request);
  mode_ = request.mode;
  n_windows_ = request.windows;
  auto configured = participant_.configure(request);
  state_ = State::configured;
  return configured;
}

std::optional<Body> Session::answer(const Start&) {
  require(state_ == State::configured && phase_ == Phase::initialise, "Start",
          "it ends the initialise phase, after a commit");
  Result result;
  result.window = -1;
  const auto begin = std::chrono::steady_clock::now();
  result.data = participant_.start();
  result.largest_step_s = participant_.largest_step();
  result.compute_s = seconds_since(begin);
  check_outgoing(result.data, -1);
  phase_ = Phase::march;
  state_ = State::marching;
  next_window_ = 0;
  next_iteration_ = 0;
  window_ = -1;
  return result;
}

std::optional<Body> Session::answer(const Advance& request) {
  require(
      state_ == State::configured || state_ == State::marching, "Advance",
      state_ == State::advanced ? "the window before is neither committed nor rolled back" : "nothing is configured");
  require(request.phase == Phase::march || capabilities_.initialise, "Advance",
          "this participant has not offered to initialise");
  require(request.phase == phase_, "Advance",
          phase_ == Phase::initialise ? "march begins with Start" : "the initialise phase is over");
  require(request.window == next_window_, "Advance",
          "window " + std::to_string(request.window) + " instead of " + std::to_string(next_window_));
  require(phase_ == Phase::initialise || request.window < static_cast<std::int64_t>(n_windows_), "Advance",
          "all windows are done");
  require(request.iteration == next_iteration_, "Advance",
          "iteration " + std::to_string(request.iteration) + " instead of " + std::to_string(next_iteration_));
  require(request.window_s > 0.0 && request.sub_cycles > 0, "Advance", "window length and sub-cycles must be positive");
  check_incoming(request.data);
  window_ = request.window;
  Result result{request.phase, request.window, request.iteration, 0.0, {}};
  const auto begin = std::chrono::steady_clock::now();
  result.data = participant_.advance(request, progress_);
  if (phase_ == Phase::initialise) {
    result.residual = participant_.residual();
  } else {
    result.largest_step_s = participant_.largest_step();
  }
  result.compute_s = seconds_since(begin);
  check_outgoing(result.data, request.window);
  if (result.residual && !std::isfinite(*result.residual))
    throw Error(ExitCode::numerics, "the residual is not finite",
                "initialise window " + std::to_string(request.window));
  state_ = State::advanced;
  return result;
}

std::optional<Body> Session::answer(const Commit& request) {
  require(state_ == State::advanced && request.window == window_, "Commit", "that window was not advanced");
  participant_.commit(request);
  state_ = phase_ == Phase::march ? State::marching : State::configured;
  next_window_ = window_ + 1;
  next_iteration_ = 0;
  return {};
}

std::optional<Body> Session::answer(const Rollback& request) {
  require(capabilities_.rollback, "Rollback", "this participant has not offered it");
  require(state_ == State::advanced && request.window == window_, "Rollback", "that window was not advanced");
  participant_.rollback(request);
  state_ = phase_ == Phase::march ? State::marching : State::configured;
  ++next_iteration_;
  return {};
}

std::optional<Body> Session::answer(const Save& request) {
  require(capabilities_.save_restore, "Save", "this participant has not offered it");
  require(state_ == State::marching && next_iteration_ == 0 && request.window == next_window_ - 1, "Save",
          "only the last committed window can be saved");
  return Saved{request.window, participant_.save(request)};
}

std::optional<Body> Session::answer(const Restore& request) {
  require(capabilities_.save_restore, "Restore", "this participant has not offered it");
  require((state_ == State::configured || state_ == State::marching) && next_iteration_ == 0, "Restore",
          "it comes between a commit and the next advance");
  require(request.window >= -1 && request.window < static_cast<std::int64_t>(n_windows_), "Restore",
          "the case has no window " + std::to_string(request.window));
  participant_.restore(request);
  phase_ = Phase::march;
  state_ = State::marching;
  window_ = request.window;
  next_window_ = request.window + 1;
  return Restored{request.window};
}

std::optional<Body> Session::answer(const Finish&) {
  require(state_ != State::greeting && state_ != State::advanced && state_ != State::finished, "Finish",
          "it comes after a commit");
  Bye bye{participant_.finish()};
  state_ = State::finished;
  return bye;
}

void Session::check_pad(const Configure& request) {
  const bool own = has_own_points(interface_);
  n_pad_values_ = own ? request.stiffness.size() : n_values_;
  const auto check = [this](const char* name, std::size_t found) {
    if (found > 0) check_length(name, found, n_pad_values_);
  };
  check("stiffness", request.stiffness.size());
  check("damping", request.damping.size());
  check("preload", request.preload.size());
  check("tension_cutoff", request.tension_cutoff.size());
  require(own != request.pad_map.empty(), "Configure",
          own ? "a participant with points of its own gets a pad_map" : "the registered cells need no pad_map");
}

std::size_t Session::length_of(const std::string& name) const {
  return belongs_to_pad(name, mode_) ? n_pad_values_ : n_values_;
}

void Session::check_length(const std::string& name, std::size_t found, std::size_t wanted) const {
  if (found == wanted) return;
  throw Error(ExitCode::protocol, "'" + name + "' has " + std::to_string(found) +
                                      " values, the registered cells have " + std::to_string(wanted));
}

void Session::check_incoming(const FieldSet& data) const {
  for (const auto& field : data.all()) check_length(field.name, field.values.size(), length_of(field.name));
}

void Session::check_outgoing(const FieldSet& data, std::int64_t window) const {
  for (const auto& field : data.all()) {
    bool registered = false;
    for (const auto& spec : interface_.fields) registered = registered || (spec.outgoing && spec.name == field.name);
    if (!registered || field.values.size() != length_of(field.name))
      throw Error(
          ExitCode::internal,
          "the participant gave the field '" + field.name + "' with " + std::to_string(field.values.size()) + " values",
          "",
          registered ? "the registered cells have " + std::to_string(length_of(field.name))
                     : "describe() does not list it");
    for (std::size_t i = 0; i < field.values.size(); ++i)
      if (!std::isfinite(field.values[i]))
        throw Error(ExitCode::numerics, "the solution is not finite: " + field.name,
                    place_of_value(i) + ", window " + std::to_string(window));
  }
}

std::string Session::place_of_value(std::size_t index) const {
  static constexpr const char* axes[] = {"longitudinal", "lateral", "normal"};
  for (const auto& seat : interface_.seats) {
    if (index < seat.points.size())
      return "rail seat '" + seat.name + "', cell " + std::to_string(index / 3) + ", " + axes[index % 3];
    index -= seat.points.size();
  }
  return "value " + std::to_string(index);
}

}  // namespace proto
