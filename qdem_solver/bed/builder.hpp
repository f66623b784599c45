// Pours, tamps and relaxes a bed with the QDEM engine.
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/bed/loose_stack.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/engine/engine.hpp"

namespace qdem::bed {

inline constexpr unsigned held_along_track = 1u;  ///< mask of a Fixity

/// How long a part of the procedure takes at least and at most [s].
struct Duration {
  double least, most;  ///< [s]
};

/// When a run may end before its last step.
struct Rest {
  double speed = 0.0;       ///< root mean square over mass [m/s]; 0: never
  double unbalanced = 0.0;  ///< ratio; 0: not asked
  double kinetic = 0.0;     ///< [J]; 0: not asked
};

/// Builds one bed; README.md describes the stages. Use once, for build(), lay_on_subgrade() or rest_anew().
class Builder {
 public:
  Builder(const Settings& settings, const BedPhysics& physics);

  /// The bed at rest. Throws proto::Error: bad_data when it misses a limit of the case, numerics from the engine.
  Bed build();

  /// `base`, the bed of the same settings at rest on rigid ground, on the subgrade of the physics: settled, under one
  /// preload too, and at rest. Throws as build().
  Bed lay_on_subgrade(Bed base);

  /// `base`, which was built with other material laws, at rest with those of the physics: loaded once more and relaxed.
  /// Throws as build().
  Bed rest_anew(Bed base);

 private:
  /// How soft stones are in a stage, and how the motion is damped.
  struct Softness {
    double young, stiffness;  ///< of stones [Pa], of contacts [N/m]
    double friction;
    double local_damping, drag;
  };
  /// Called every few steps with the time since the run began [s]; true ends it.
  using Look = std::function<bool(double)>;
  void take_over(Bed base);
  /// True moduli, contacts and friction, the sleeper held along the track.
  void make_real();
  /// The last of every way to a bed; `start`: when the work on it began.
  Bed loaded_and_at_rest(std::chrono::steady_clock::time_point start);
  void make_stones();
  void pour_layer();
  void pour_crib();
  /// The wall and stones beyond the profile go, a formwork comes; stones get their true size and shape where they are,
  /// at rest.
  void strip();
  void settle();
  void harden();
  /// Load cycles while friction is still that of pouring, which packs densely.
  void consolidate();
  /// The formwork goes, friction gets its true value, and the load comes once more.
  void release();
  void load_once();  ///< the preload comes and goes
  void ramp_load(double from, double to);
  void come_to_rest();
  bool at_rest() const;  ///< within the limits of the case, as last reported
  void finish();
  void check_limits() const;

  void add_planes();
  void soften(const Softness& softness);
  void add_stones(const std::vector<Stone>& stones, const std::vector<Rectangle>& floor, double bottom);
  /// A frictionless board on the slope, as far out as the outermost stone.
  void lay_formwork();
  void take_formwork_away();
  void hold_sleeper(unsigned mask);
  void drop_contacts();
  void drop_spare_lanes();

  /// Relaxes (relaxation.hpp) for at least duration.least [s]; then ends early at rest, or any time when `look` says
  /// so.
  void run(const Duration& duration, const Rest& rest = {}, const Look& look = {});
  void run_steps(int most, const Rest& rest);
  void run_with_true_masses(int least_steps, int most_steps, const Rest& rest);
  int contact_points() const;  ///< of a stone, for the relaxation's step
  void march(Engine& engine, double dt, const Duration& duration, const Rest& rest, const Look& look);
  /// Presses a plane down on the stones to `level` [m] or until it bears `pressure` [Pa]; returns where it stopped [m].
  double tamp(double level, double pressure);
  double pressure_on(double level, double area) const;
  double top_of_stones() const;
  double mass_of_stones() const;
  double sleeper_weight() const;  ///< [N]
  Eigen::Vector3d body_centre(int body) const;
  /// Level of the ramp from pouring (0) to real stiffness (ramp_levels).
  Softness at_level(int level) const;
  int settling_level() const { return (3 * settings_.ramp_levels + 7) / 8; }
  double rattling_frequency(double stiffness) const;
  double seat_height() const;
  double envelope_volume(int template_id, double size) const;

  const Settings& settings_;
  const BedPhysics& physics_;
  Random random_;
  std::vector<Stone> layer_, crib_;
  const char* stage_ = "";       ///< for the log
  bool falling_ = true;          ///< stones may still fall on others
  double loaded_height_ = 0.0;   ///< of the seat under the last preload [m]
  double ground_ = 0.0;          ///< where stones stand, before the last shift [m]
  double sleeper_bottom_ = 0.0;  ///< where the tamped layer ends, before the last shift [m]
  Model model_;
  State state_;
  BedReport report_;
};

}  // namespace qdem::bed
