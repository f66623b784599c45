// One side of the split oscillator, `--side explicit` or `implicit`, that breaks one rule: `--fault NAME`. `none`
// breaks none. For what the conformance suite has to catch; careless_wire.hpp has the faults of the wire.
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <random>
#include <string>

#include "proto/case/rail_seat.hpp"
#include "proto/result/state_file.hpp"
#include "tests/support/careless_wire.hpp"
#include "tests/support/command_option.hpp"
#include "tests/support/oscillator_sides.hpp"

namespace {

namespace field = proto::field;

constexpr int normal = 2;

std::vector<double> along_normal(double value) {
  return {0.0, 0.0, value};
}

tests::Oscillator placed(bool rail, double displacement, double velocity) {
  tests::Oscillator o;
  (rail ? o.u : o.x) = displacement;
  (rail ? o.v : o.y) = velocity;
  return o;
}

/// The models know one value, the wire three per cell: only the normal one moves.
template <class Model>
class Broken : public proto::Participant {
 public:
  Broken(std::string name, proto::RailSeat seat, std::string fault)
      : name_(std::move(name)), seat_(std::move(seat)), fault_(std::move(fault)) {}

  void watch(proto::Progress& progress) override { progress_ = &progress; }
  std::string name() const override { return name_; }
  proto::Capabilities capabilities() const override {
    proto::Capabilities can;
    can.robin = is_rail;
    can.rollback = can.save_restore = true;
    can.initialise = fault_ == "no_residual";
    return can;
  }
  proto::Interface describe() override;
  proto::Configured configure(const proto::Configure&) override {
    proto::Configured configured;
    if (!is_rail) configured.largest_step_s = 0.0125;
    return configured;
  }
  proto::FieldSet start() override {
    proto::FieldSet data;
    data.set(is_rail ? field::rail_displacement : field::sleeper_displacement, along_normal(model_.displacement()));
    data.set(is_rail ? field::rail_velocity : field::sleeper_velocity, along_normal(model_.velocity()));
    return data;
  }
  proto::FieldSet advance(const proto::Advance& request, proto::Progress& progress) override;
  void commit(const proto::Commit&) override { kept_ = model_; }
  void rollback(const proto::Rollback&) override {
    if (fault_ != "no_rollback") model_ = kept_;
  }
  std::uint64_t save(const proto::Save& request) override {
    proto::StateWriter archive;
    double displacement = kept_.displacement(), velocity = kept_.velocity();
    archive("displacement", displacement);
    archive("velocity", velocity);
    return archive.write(request.path);
  }
  void restore(const proto::Restore& request) override {
    proto::StateReader archive(request.path, request.hash);
    double displacement = 0.0, velocity = 0.0;
    archive("displacement", displacement);
    archive("velocity", velocity);
    if (fault_ == "half_a_state") velocity = 0.0;
    kept_ = model_ = Model(placed(is_rail, displacement, velocity));
  }
  std::vector<proto::Fact> finish() override { return {}; }

 private:
  static constexpr bool is_rail = std::is_same_v<Model, tests::RailModel>;

  void nudge(double by) { model_ = Model(placed(is_rail, model_.displacement() + by, model_.velocity())); }
  void spoil(proto::FieldSet& data, const proto::Advance& request) const;

  std::string name_;
  proto::RailSeat seat_;
  std::string fault_;
  proto::Progress* progress_ = nullptr;
  Model model_{tests::Oscillator{}}, kept_{tests::Oscillator{}};
};

template <class Model>
proto::Interface Broken<Model>::describe() {
  proto::SeatRegistration r;
  r.name = seat_.name;
  const Eigen::Vector3d point = seat_.cell_point(0);
  r.points = {point[0], point[1], point[2]};
  r.weights = {1.0};
  for (int i = 0; i < 18; ++i) r.rigid_response.push_back(i < 9 ? seat_.axes(i / 3, i % 3) : 0.0);
  for (int i = 0; i < 18; ++i) r.force_resultants.push_back(i % 6 < 3 ? seat_.axes(i % 6, i / 6) : 0.0);
  if (fault_ == "bent_operator") r.rigid_response[8] = 0.999;
  proto::Interface interface;
  if (is_rail) {
    interface.fields = {{field::rail_displacement, "m", 3, true},
                        {field::rail_velocity, "m/s", 3, true},
                        {field::force_robin, "N", 3, true},
                        {field::force_used, "N", 3, true}};
  } else {
    r.stiffness = {0, 0, 10}, r.damping = {0, 0, 0.2}, r.preload = {0, 0, 0}, r.tension_cutoff = {false, false, false};
    interface.fields = {{field::impulse, fault_ == "wrong_unit" ? "kN s" : "N s", 3, true},
                        {field::pad_work, "J", 3, true},
                        {field::sleeper_displacement, "m", 3, true},
                        {field::sleeper_velocity, "m/s", 3, true}};
  }
  interface.seats = {r};
  return interface;
}

/// What the fault makes of an answer that was right.
template <class Model>
void Broken<Model>::spoil(proto::FieldSet& data, const proto::Advance& request) const {
  if (fault_ == "end_force") {  // the force at the window's end for the mean
    const double u = request.data.get(field::rail_displacement)[normal];
    const double force = 10.0 * (u - model_.displacement()) - 0.2 * model_.velocity();
    data.set(field::impulse, along_normal(force * request.window_s));
  }
  if (fault_ == "carry_added" && data.has(field::force_robin))
    data.set(field::force_used,
             along_normal(data.get(field::force_robin)[normal] + request.data.get(field::force_carry)[normal]));
  if (fault_ == "short_field") data.set(field::pad_work, {0.0});
}

template <class Model>
proto::FieldSet Broken<Model>::advance(const proto::Advance& request, proto::Progress& progress) {
  auto narrow = request;
  narrow.data = {};
  for (const auto& f : request.data.all()) {
    if (fault_ == "strict_fields" && f.name.find("later_version") != std::string::npos)
      throw proto::Error(proto::ExitCode::protocol, "what is '" + f.name + "'?");
    const double sign = fault_ == "wrong_way" && f.name == field::force_mean ? -1.0 : 1.0;
    narrow.data.set(f.name, {sign * f.values.at(normal)});
  }
  if (fault_ == "nudged") nudge(1e-2 * request.sub_cycles);
  if (fault_ == "unseeded") nudge(1e-9 * std::random_device{}());
  proto::FieldSet data;
  const std::uint32_t chunk = 1u << 20;  // the models do not count; the wire wants to see work
  auto result = [&] {
    if (request.sub_cycles <= chunk) return model_.advance(narrow);
    proto::Result last;
    for (std::uint32_t done = 0; done < request.sub_cycles; done += chunk) {
      auto part = narrow;
      part.sub_cycles = chunk;
      last = model_.advance(part);
      progress.bump();
    }
    return last;
  }();
  progress.bump();
  for (const auto& f : result.data.all()) data.set(f.name, along_normal(f.values.at(0)));
  if (fault_ == "wrong_way" && request.data.has(field::force_mean))
    data.set(field::force_used, request.data.get(field::force_mean));
  spoil(data, request);
  return data;
}

/// A process that nobody ends with its parent; for a minute.
void leave_a_child() {
  if (fork() != 0) return;
  setsid();
  sleep(60);
  _exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  using tests::option;
  try {
    const auto file = proto::CaseFile::load(option(argc, argv, "--case"));
    const auto seat = proto::read_rail_seats(file).front();
    const auto options = proto::read_session_options(option(argc, argv, "--endpoint"), file.hash());
    const auto name = option(argc, argv, "--name"), fault = option(argc, argv, "--fault");
    if (fault == "leaves_a_child") leave_a_child();
    std::unique_ptr<proto::Participant> side;
    if (option(argc, argv, "--side") == "implicit")
      side = std::make_unique<Broken<tests::RailModel>>(name, seat, fault);
    else
      side = std::make_unique<Broken<tests::SleeperModel>>(name, seat, fault);
    tests::CarelessWire(*side, options, fault).run();
    return fault == "fails_at_the_end" ? 1 : 0;
  } catch (const proto::Error& error) {
    std::fprintf(stderr, "broken_participant: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
