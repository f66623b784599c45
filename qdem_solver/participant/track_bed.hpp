// The bed under its rail pads, ready to be integrated: what the participant and the run alone share.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/result/attributes.hpp"
#include "proto/wire/messages.hpp"
#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/relaxation.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "qdem_solver/participant/qdem_case.hpp"

namespace qdem {

/// Where the bed comes from: make_bed() in the program, something small in tests.
using BedSource = std::function<Bed(const proto::CaseFile&, const BedPhysics&)>;

/// Whether the loads of [qdem.run] act on the bed.
enum class BedRole { coupled, alone };

/// Bed, pads, engine and step bound of one case. Not movable: the engine refers to the model inside.
class TrackBed {
 public:
  /// Reads `[qdem]` and `[[rail_seat]]`, takes the bed from `source`, lays the pads.
  /// `on_step` is called after every step. Throws what the source, read_qdem_case(), make_pad_cells() and
  /// make_patch_loads() throw, and proto::Error: bad_data for bodies that overlap by more than the case allows, config
  /// for a largest_step_s above the stability bound.
  TrackBed(const proto::CaseFile& file, const BedSource& source, std::function<void()> on_step,
           BedRole role = BedRole::coupled);
  TrackBed(const TrackBed&) = delete;
  TrackBed& operator=(const TrackBed&) = delete;

  const QdemCase& settings() const { return settings_; }
  const std::vector<proto::RailSeat>& seats() const { return seats_; }
  const Model& model() const { return bed_.model; }
  State& state() { return bed_.state; }
  Engine& engine() { return *engine_; }
  double largest_step() const { return largest_step_; }           ///< as last found, safety included [s]
  double step_bound() const { return step_bound_; }               ///< the same without safety or limit of the case [s]
  double relaxation_step() const { return relaxation_->step(); }  ///< the same while relaxing [s]

  /// Finds largest_step() for the next `duration` [s] of motion: contacts that may form meanwhile count. Never above
  /// the case's largest_step_s.
  void find_step(double duration);

  /// From now on bodies are relaxed: Cundall's damping, and inertia that makes relaxation_step() stable.
  void relax();
  /// Fits that inertia to the contacts of now.
  void fit_inertia() { relaxation_->fit(*engine_, bed_.state); }
  /// Ends it: `duration` [s] more with the damping but at true masses, the rail foot held at `rail_foot`; then without.
  void release(double duration, const std::vector<double>& rail_foot);
  /// Sets step and time to 0 and opens the energy ledger; motion and contact history stay.
  void begin_march();

  /// Displacement from the bed's rest, and velocity, of the sleeper at the pad cells.
  std::vector<double> pad_displacement() const { return engine_->pad_displacement(bed_.state, rest_.x); }
  std::vector<double> pad_velocity() const { return engine_->pad_velocity(bed_.state); }

  /// The bed's and the time step's figures for the summary.
  std::vector<proto::Fact> facts() const;
  const std::string& bed_hash() const { return bed_.report.hash; }
  /// Provenance, bed hash and seed for result files.
  proto::Attributes attributes(const proto::CaseFile& file) const;

 private:
  void check_step(const proto::CaseFile& file) const;
  /// The subgrade's elements; how much of pad and ground is pressed, and what these cost: the step's bound over that on
  /// rigid ones.
  void add_layers(std::vector<proto::Fact>& facts) const;
  double touching_gap() const;  ///< for bodies that hardly move [m]

  QdemCase settings_;
  std::vector<proto::RailSeat> seats_;
  Bed bed_;
  State rest_;
  std::unique_ptr<Engine> engine_;
  std::optional<Relaxation> relaxation_;
  std::optional<StepBound> bound_;
  double step_bound_ = 0.0, largest_step_ = 0.0;
};

/// Checks `[qdem]` and `[[rail_seat]]`, and that the engine asked for is there. Throws proto::Error (config).
void check_case(const proto::CaseFile& file);

}  // namespace qdem
