// The smallest participants there are: two masses on springs, joined by the pad of one rail seat.
//
// A stranger who writes a participant reads this first. Each side implements proto::Participant and calls
// proto::serve(); everything about sockets, messages and their order is the session's. The explicit side stands for
// the QDEM (it owns the pad and forms the window's impulse), the implicit side for the FEM (it solves against a
// predicted sleeper). Both move along the seat's normal axis only. Formulation of this project, proto/README.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "proto/case/case_schema.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/result/state_file.hpp"
#include "proto/session/participant.hpp"

namespace {

using namespace proto;

constexpr int normal = 2;  // the only axis that moves; values of the other two are zero

/// One mass on one spring to the ground: `[oscillator.explicit]` or `[oscillator.implicit]` of the case.
struct Oscillator {
  double mass = 0.0;       ///< [kg]
  double stiffness = 0.0;  ///< [N/m]
  double displacement = 0.0, velocity = 0.0;
  double largest_step = 0.0;  ///< explicit side only; 0: from the stability bound [s]
};

Oscillator read_oscillator(const Section& section) {
  Oscillator body;
  body.mass = section.number("mass_kg", Range::positive());
  body.stiffness = section.number("ground_stiffness_n_per_m", Range::not_negative());
  body.displacement = section.number("initial_displacement_m");
  body.velocity = section.number("initial_velocity_m_per_s");
  return body;
}

struct OscillatorCase {
  RailSeat seat;
  Oscillator explicit_side, implicit_side;
};

OscillatorCase read_case(const CaseFile& file) {
  const auto seats = read_rail_seats(file);
  if (seats.size() != 1 || seats[0].n_cells() != 1)
    throw Error(ExitCode::config, "an oscillator has one rail seat with one cell", file.path());
  const auto section = file.section("oscillator");
  OscillatorCase result{seats[0], read_oscillator(section.section("explicit")),
                        read_oscillator(section.section("implicit"))};
  result.explicit_side.largest_step =
      section.section("explicit").number_or("largest_step_s", 0.0, Range::not_negative());
  section.finish();  // refuses the keys that nobody read
  return result;
}

/// One value per seat axis.
std::vector<double> along_normal(double value) {
  return {0.0, 0.0, value};
}

/// What both sides have in common. The state of the last commit is kept, so that a window can be taken back.
class Side : public Participant {
 public:
  Side(std::string name, std::string fact_prefix, RailSeat seat, Oscillator body)
      : name_(std::move(name)), fact_prefix_(std::move(fact_prefix)), seat_(std::move(seat)), now_(body), kept_(body) {}

  std::string name() const override { return name_; }
  std::string build_id() const override { return "oscillator_participant"; }
  Capabilities capabilities() const override {
    Capabilities can;
    can.robin = can.rollback = can.save_restore = true;
    return can;
  }
  void commit(const Commit&) override {
    kept_ = now_;
    ++n_windows_;
  }
  void rollback(const Rollback&) override { now_ = kept_; }
  std::uint64_t save(const Save& request) override {
    StateWriter archive;
    exchange(archive);
    return archive.write(request.path);
  }
  void restore(const Restore& request) override {
    StateReader archive(request.path, request.hash);
    exchange(archive);
    now_ = kept_;
  }
  std::vector<Fact> finish() override {
    return {{fact_prefix_ + ".x", kept_.displacement, ""},
            {fact_prefix_ + ".v", kept_.velocity, ""},
            {fact_prefix_ + ".time_s", static_cast<double>(n_windows_) * window_s_, ""}};
  }

 protected:
  /// What the coupler judges the stability of its schemes by.
  std::vector<Fact> mass_fact() const { return {{name_ + ".seat_mass_kg", now_.mass, ""}}; }

  /// What a restart needs, for both ways.
  void exchange(StateArchive& archive) {
    archive.expect_same("participant", "the oscillator's side", fact_prefix_);
    archive("displacement", kept_.displacement);
    archive("velocity", kept_.velocity);
    archive("windows", n_windows_);
  }

  /// The only cell lies at the seat's origin and follows the body's translation; a rotation about the origin leaves it
  /// where it is, and a force there has no moment about it.
  SeatRegistration registration() const {
    SeatRegistration seat;
    seat.name = seat_.name;
    const Eigen::Vector3d point = seat_.cell_point(0);
    seat.points = {point[0], point[1], point[2]};
    seat.weights = {1.0};
    for (int motion = 0; motion < 6; ++motion)
      for (int axis = 0; axis < 3; ++axis) seat.rigid_response.push_back(motion < 3 ? seat_.axes(motion, axis) : 0.0);
    for (int axis = 0; axis < 3; ++axis)
      for (int component = 0; component < 6; ++component)
        seat.force_resultants.push_back(component < 3 ? seat_.axes(component, axis) : 0.0);
    return seat;
  }

  std::string name_, fact_prefix_;
  RailSeat seat_;
  Oscillator now_, kept_;
  double window_s_ = 0.0;
  std::uint64_t n_windows_ = 0;  ///< committed
};

/// What drives the sleeper over one window, s from 0 to 1: the rail through the pad, along a straight path or a cubic
/// one where its slopes are given; or, in a rigid joint, a force that is linear in time.
struct Drive {
  bool joint, cubic;
  double begin, end;                          ///< joint: force [N]; else displacement of the rail [m]
  double slope_begin = 0.0, slope_end = 0.0;  ///< of the cubic path, times the window [m]
  double window_s;

  explicit Drive(const Advance& request)
      : joint(request.data.has(field::joint_force)),
        cubic(request.data.has(field::path_velocity)),
        begin(normal_value(request, joint ? field::joint_force_begin : field::rail_displacement_begin)),
        end(normal_value(request, joint ? field::joint_force : field::rail_displacement)),
        window_s(request.window_s) {
    if (!cubic) return;
    slope_begin = window_s * normal_value(request, field::path_velocity_begin);
    slope_end = window_s * normal_value(request, field::path_velocity);
  }
  static double normal_value(const Advance& request, const char* name) { return request.data.get(name)[normal]; }

  double value(double s) const {
    if (!cubic) return begin + (end - begin) * s;
    const double r = 1.0 - s;
    return r * r * ((1.0 + 2.0 * s) * begin + s * slope_begin) + s * s * ((3.0 - 2.0 * s) * end - r * slope_end);
  }
  double rate(double s) const {
    if (!cubic) return (end - begin) / window_s;
    const double r = 1.0 - s;
    return (6.0 * s * r * (end - begin) + r * (1.0 - 3.0 * s) * slope_begin + s * (3.0 * s - 2.0) * slope_end) /
           window_s;
  }
  /// On a sleeper at x that moves with v [N].
  double force(const PadLaw& pad, double s, double x, double v) const {
    return joint ? value(s) : pad.force(value(s) - x, rate(s) - v);
  }
};

/// The sleeper's side: kick-drift-kick steps under the pad force, along the rail's linear path.
class ExplicitSide : public Side {
 public:
  using Side::Side;

  Interface describe() override {
    auto seat = registration();
    for (int axis = 0; axis < 3; ++axis) {
      const PadLaw law = seat_.cell_law(axis);
      seat.stiffness.push_back(law.stiffness);
      seat.damping.push_back(law.damping);
      seat.preload.push_back(law.preload);
      seat.tension_cutoff.push_back(law.tension_cutoff);
    }
    return {{{field::rail_displacement_begin, "m", 3, false},
             {field::rail_displacement, "m", 3, false},
             {field::path_velocity_begin, "m/s", 3, false},
             {field::path_velocity, "m/s", 3, false},
             {field::joint_force_begin, "N", 3, false},
             {field::joint_force, "N", 3, false},
             {field::impulse, "N s", 3, true},
             {field::pad_work, "J", 3, true},
             {field::sleeper_displacement, "m", 3, true},
             {field::sleeper_velocity, "m/s", 3, true}},
            {seat}};
  }

  /// Largest stable step of central differences with a lagging dashpot, with a margin of one half; or less, if the case
  /// asks for it with `largest_step_s`.
  Configured configure(const Configure& request) override {
    window_s_ = request.window_s;
    const PadLaw pad = seat_.cell_law(normal);
    const double frequency = std::sqrt((now_.stiffness + pad.stiffness) / now_.mass);
    Configured configured{{}, mass_fact(), {}};
    if (now_.largest_step > 0.0) configured.largest_step_s = now_.largest_step;
    if (frequency == 0.0) return configured;
    const double ratio = pad.damping / (2.0 * now_.mass * frequency);
    const double bound = 0.5 * 2.0 / frequency * (std::sqrt(1.0 + ratio * ratio) - ratio);
    configured.largest_step_s = std::min(bound, configured.largest_step_s.value_or(bound));
    return configured;
  }

  FieldSet start() override {
    FieldSet data;
    put_motion(data);
    return data;
  }

  FieldSet advance(const Advance& request, Progress& progress) override {
    const double step = request.window_s / request.sub_cycles;
    const PadLaw pad = seat_.cell_law(normal);
    const Drive drive(request);
    double& x = now_.displacement;
    double& v = now_.velocity;
    double force = drive.force(pad, 0.0, x, v);
    double impulse = 0.0, work = 0.0;
    window_s_ = request.window_s;
    for (std::uint32_t j = 1; j <= request.sub_cycles; ++j) {
      const double s = static_cast<double>(j) / request.sub_cycles, x_before = x, before = force;
      const double rail_step = drive.value(s) - drive.value(static_cast<double>(j - 1) / request.sub_cycles);
      const double acceleration = (force - now_.stiffness * x) / now_.mass;
      const double half_kicked = v + 0.5 * step * acceleration;
      x += step * half_kicked;
      // The dashpot acts at the force's own time level, hence on the predicted end velocity: second order.
      force = drive.force(pad, s, x, v + step * acceleration);
      v = half_kicked + 0.5 * step * (force - now_.stiffness * x) / now_.mass;
      impulse += 0.5 * step * (before + force);  // exactly what the two half-kicks gave the mass
      work += 0.5 * (before + force) * (drive.joint ? x - x_before : rail_step);
      progress.bump();
    }
    FieldSet data;
    data.set(field::impulse, along_normal(impulse));
    data.set(field::pad_work, along_normal(work));
    put_motion(data);
    return data;
  }

 private:
  void put_motion(FieldSet& data) const {
    data.set(field::sleeper_displacement, along_normal(now_.displacement));
    data.set(field::sleeper_velocity, along_normal(now_.velocity));
  }
};

/// The rail's side: one step of average acceleration in momentum form a window, against the predicted mean motion of
/// the sleeper (robin) or under a given mean force.
class ImplicitSide : public Side {
 public:
  using Side::Side;

  Interface describe() override {
    return {{{field::sleeper_mean_displacement, "m", 3, false},
             {field::sleeper_mean_velocity, "m/s", 3, false},
             {field::force_carry, "N", 3, false},
             {field::force_mean, "N", 3, false},
             {field::joint_force_begin, "N", 3, false},
             {field::joint_force, "N", 3, false},
             {field::rail_displacement, "m", 3, true},
             {field::rail_velocity, "m/s", 3, true},
             {field::force_robin, "N", 3, true},
             {field::force_used, "N", 3, true}},
            {registration()}};
  }

  Configured configure(const Configure& request) override {
    window_s_ = request.window_s;
    mode_ = request.mode;
    pad_ = {request.stiffness.at(normal), request.damping.at(normal), request.preload.at(normal),
            request.tension_cutoff.at(normal)};
    return {{}, mass_fact(), {}};
  }

  FieldSet start() override {
    FieldSet data;
    put_motion(data);
    return data;
  }

  FieldSet advance(const Advance& request, Progress& progress) override {
    const double h = request.window_s;
    window_s_ = h;
    FieldSet data;
    if (mode_ == LoadMode::prescribed_force) {
      const bool joint = request.data.has(field::joint_force);
      const double force = joint ? 0.5 * (request.data.get(field::joint_force_begin)[normal] +
                                          request.data.get(field::joint_force)[normal])
                                 : request.data.get(field::force_mean)[normal];
      solve(h, 0.0, 0.0, -force);
      data.set(field::force_used, along_normal(force));
    } else {
      const double x = request.data.get(field::sleeper_mean_displacement)[normal];
      const double y = request.data.get(field::sleeper_mean_velocity)[normal];
      const double carry = request.data.get(field::force_carry)[normal];
      const double robin = solve_robin(h, x, y, carry);
      data.set(field::force_robin, along_normal(robin));
      data.set(field::force_used, along_normal(robin - carry));
    }
    progress.bump();
    put_motion(data);
    return data;
  }

 private:
  /// Solves with spring and dashpot of the pad in the matrix; returns the pad's mean force on the sleeper. With the
  /// tension cut-off the pad may turn out to be off the rail: then its clip alone pulls.
  double solve_robin(double h, double x, double y, double carry) {
    const Oscillator before = now_;
    solve(h, pad_.stiffness, pad_.damping, pad_.stiffness * x + pad_.damping * y + carry);
    const double mean = 0.5 * (before.displacement + now_.displacement);
    const double mean_rate = (now_.displacement - before.displacement) / h;
    if (!pad_.engaged(mean - x, mean_rate - y)) {
      now_ = before;
      solve(h, 0.0, 0.0, carry - pad_.preload);
    }
    return pad_.force(mean - x, mean_rate - y);
  }

  /// M (v1 - v0)/H + (K + k) (u0 + u1)/2 + c (u1 - u0)/H = load with u1 = u0 + H (v0 + v1)/2, for the mean velocity.
  void solve(double h, double k, double c, double load) {
    const double stiffness = now_.stiffness + k;
    const double mean_velocity = (2.0 * now_.mass / h * now_.velocity - stiffness * now_.displacement + load) /
                                 (2.0 * now_.mass / h + 0.5 * h * stiffness + c);
    now_.displacement += h * mean_velocity;
    now_.velocity = 2.0 * mean_velocity - now_.velocity;
  }

  void put_motion(FieldSet& data) const {
    data.set(field::rail_displacement, along_normal(now_.displacement));
    data.set(field::rail_velocity, along_normal(now_.velocity));
  }

  LoadMode mode_ = LoadMode::robin;
  PadLaw pad_;
};

int run(int argc, char** argv) {
  CLI::App app("One side of the split oscillator (cases/split_oscillator).", "oscillator_participant");
  app.require_subcommand(1);
  std::string path, side, endpoint, out, name;
  KeyFiles keys;
  auto* check = app.add_subcommand("check", "validate the case without running it");
  auto* participant = app.add_subcommand("participant", "take part in a coupled run; started by the coupler");
  auto* schema = app.add_subcommand("schema", "print the JSON Schema of the sections that it reads");
  for (auto* command : {check, participant}) command->add_option("--case", path, "case file")->required();
  participant->add_option("--side", side, "which mass")->required()->check(CLI::IsMember({"explicit", "implicit"}));
  participant->add_option("--endpoint", endpoint, "where the coupler listens")->required();
  participant->add_option("--server-key", keys.server, "public key of a coupler on another machine");
  participant->add_option("--key", keys.own, "own secret key");
  participant->add_option("--out", out, "output folder (nothing is written)");
  participant->add_option("--name", name, "name in the session")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }
  if (schema->parsed()) {
    std::printf("%s\n",
                case_schema({[](const CaseFile& any) { read_case(any); }}, {"rail_seat = [{cells = [1, 1]}]"}).c_str());
    return 0;
  }
  const auto file = CaseFile::load(path);
  const auto input = read_case(file);
  if (check->parsed()) return 0;
  const auto options = read_session_options(endpoint, file.hash(), keys);
  if (side == "explicit") {
    ExplicitSide body(name, "oscillator.explicit", input.seat, input.explicit_side);
    serve(body, options);
  } else {
    ImplicitSide body(name, "oscillator.implicit", input.seat, input.implicit_side);
    serve(body, options);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    std::fprintf(stderr, "oscillator_participant: %s\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "oscillator_participant: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::internal);
  }
}
