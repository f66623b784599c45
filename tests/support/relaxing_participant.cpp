// One side of the split oscillator under a constant load, with an initialise phase: `--side rail` or `--side sleeper`.
// Damps artificially by taking 5 % of the velocity in each window of that phase. `--fault` makes it misbehave:
// soft_pad: the rail has 0.93 of the pad's stiffness and damping; no_residual; negative_residual; nan: a number that is
// not finite in a message; and in window 3 of the march hang: it computes no more and its heart goes on beating; exit:
// it ends as if all were well.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "proto/case/rail_seat.hpp"
#include "proto/session/participant.hpp"
#include "tests/support/command_option.hpp"
#include "tests/support/oscillator_sides.hpp"

namespace {

namespace field = proto::field;

constexpr double load_n = -13.5, kept_velocity = 0.95;

tests::Oscillator loaded_oscillator(const std::string& fault = {}) {
  tests::Oscillator o;
  if (fault == "soft_pad") o.pad.stiffness *= 0.93, o.pad.damping *= 0.93;
  o.u = o.v = o.x = o.y = 0.0;
  o.rail_load = load_n;
  return o;
}

/// The models know one value, the wire three per cell: only the normal one moves.
proto::FieldSet widened(const proto::FieldSet& data) {
  proto::FieldSet result;
  for (const auto& f : data.all()) result.set(f.name, {0.0, 0.0, f.values.at(0)});
  return result;
}

proto::FieldSet narrowed(const proto::FieldSet& data) {
  proto::FieldSet result;
  for (const auto& f : data.all()) result.set(f.name, {f.values.at(2)});
  return result;
}

template <class Model>
class Relaxing : public proto::Participant {
 public:
  Relaxing(std::string name, proto::RailSeat seat, std::string fault)
      : name_(std::move(name)), seat_(std::move(seat)), fault_(std::move(fault)), model_(loaded_oscillator(fault_)) {}
  std::string name() const override { return name_; }
  proto::Capabilities capabilities() const override { return {true, false, false, true}; }
  proto::Interface describe() override;
  proto::Configured configure(const proto::Configure&) override {
    if (fault_ == "nan") return {std::nan(""), {}};
    return {};
  }
  proto::FieldSet advance(const proto::Advance& request, proto::Progress& progress) override {
    if (request.phase == proto::Phase::march && request.window == 3) misbehave();
    auto narrow = request;
    narrow.data = narrowed(request.data);
    const double before = model_.velocity();
    const auto result = model_.advance(narrow);
    inertia_force_ = mass() * std::abs(model_.velocity() - before) / request.window_s;
    if (request.phase == proto::Phase::initialise) model_.damp(kept_velocity);
    progress.bump();
    return widened(result.data);
  }
  std::optional<double> residual() override {
    if (fault_ == "no_residual") return std::nullopt;
    return fault_ == "negative_residual" ? -0.5 : inertia_force_ / std::abs(load_n);
  }
  void commit(const proto::Commit&) override {}
  proto::FieldSet start() override {
    const bool rail = std::is_same_v<Model, tests::RailModel>;
    proto::FieldSet data;
    data.set(rail ? field::rail_displacement : field::sleeper_displacement, {model_.displacement()});
    data.set(rail ? field::rail_velocity : field::sleeper_velocity, {model_.velocity()});
    return widened(data);
  }
  std::vector<proto::Fact> finish() override { return {}; }

 private:
  void misbehave() const {
    while (fault_ == "hang") pause();
    if (fault_ == "exit") std::_Exit(0);
  }

  static double mass() {
    const auto o = loaded_oscillator();
    return std::is_same_v<Model, tests::RailModel> ? o.rail_mass : o.sleeper_mass;
  }

  std::string name_;
  proto::RailSeat seat_;
  std::string fault_;
  double inertia_force_ = 0.0;
  Model model_;
};

template <class Model>
proto::Interface Relaxing<Model>::describe() {
  proto::SeatRegistration r;
  r.name = seat_.name;
  const Eigen::Vector3d point = seat_.cell_point(0);
  r.points = {point[0], point[1], point[2]};
  r.weights = {1.0};
  for (int i = 0; i < 18; ++i) r.rigid_response.push_back(i < 9 ? seat_.axes(i / 3, i % 3) : 0.0);
  for (int i = 0; i < 18; ++i) r.force_resultants.push_back(i % 6 < 3 ? seat_.axes(i % 6, i / 6) : 0.0);
  proto::Interface interface;
  if (std::is_same_v<Model, tests::SleeperModel>) {
    r.stiffness = {0, 0, 10}, r.damping = {0, 0, 0.2}, r.preload = {0, 0, 0}, r.tension_cutoff = {false, false, false};
    interface.fields = {{field::impulse, "N s", 3, true},
                        {field::pad_work, "J", 3, true},
                        {field::sleeper_displacement, "m", 3, true},
                        {field::sleeper_velocity, "m/s", 3, true}};
  } else {
    interface.fields = {{field::rail_displacement, "m", 3, true},
                        {field::rail_velocity, "m/s", 3, true},
                        {field::force_robin, "N", 3, true},
                        {field::force_used, "N", 3, true}};
  }
  interface.seats = {r};
  return interface;
}

}  // namespace

int main(int argc, char** argv) {
  using tests::option;
  try {
    const auto file = proto::CaseFile::load(option(argc, argv, "--case"));
    const auto seat = proto::read_rail_seats(file).front();
    const auto options = proto::read_session_options(option(argc, argv, "--endpoint"), file.hash());
    const auto name = option(argc, argv, "--name");
    const auto fault = option(argc, argv, "--fault");
    std::unique_ptr<proto::Participant> side;
    if (option(argc, argv, "--side") == "rail")
      side = std::make_unique<Relaxing<tests::RailModel>>(name, seat, fault);
    else
      side = std::make_unique<Relaxing<tests::SleeperModel>>(name, seat, fault);
    proto::serve(*side, options);
    return 0;
  } catch (const proto::Error& error) {
    std::fprintf(stderr, "relaxing_participant: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
