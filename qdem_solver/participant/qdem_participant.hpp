// The QDEM solver as a participant of a coupled run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/session/participant.hpp"
#include "qdem_solver/output/fields_file.hpp"
#include "qdem_solver/participant/energy_watch.hpp"
#include "qdem_solver/participant/track_bed.hpp"
#include "qdem_solver/sensors/sensor_file.hpp"

namespace qdem {

/// Adapter from the session to the engine. describe() builds or loads the bed; a window is `sub_cycles` steps with the
/// rail foot moving linearly; the impulse and the pads' work are formed step by step from the forces the integrator
/// used.
class QdemParticipant : public proto::Participant {
 public:
  /// `out`: folder of qdem.h5 unless Configure names another.
  QdemParticipant(proto::CaseFile file, BedSource source, std::string name, std::string out);
  ~QdemParticipant() override;

  std::string build_id() const override;
  std::string name() const override { return name_; }
  proto::Capabilities capabilities() const override;
  void watch(proto::Progress& progress) override { progress_ = &progress; }
  proto::Interface describe() override;
  proto::Configured configure(const proto::Configure& request) override;
  proto::FieldSet advance(const proto::Advance& request, proto::Progress& progress) override;
  /// Engine::unbalanced_ratio() of the window's last step.
  std::optional<double> residual() override;
  /// Of the next window, from the contacts that may form in it.
  std::optional<double> largest_step() override;
  void commit(const proto::Commit& request) override;
  void rollback(const proto::Rollback& request) override;
  proto::FieldSet start() override;
  std::uint64_t save(const proto::Save& request) override;
  void restore(const proto::Restore& request) override;
  std::vector<proto::Fact> finish() override;

 private:
  proto::FieldSet values(PadSums sums) const;
  void begin_window(const proto::Advance& request);
  void check_sensor_interval() const;
  void open_files();
  void resume_files(proto::StateArchive& saved);
  /// Everything but the files' own counts.
  void exchange(proto::StateArchive& archive);
  State start_state() const;
  bool output_is_due(std::int64_t window) const;

  proto::CaseFile file_;
  BedSource source_;
  std::string name_, out_;
  proto::Progress* progress_ = nullptr;
  std::unique_ptr<TrackBed> bed_;
  std::unique_ptr<FieldsFile> fields_;
  std::unique_ptr<SensorFile> sensors_;
  EnergyWatch energy_;
  std::int64_t last_energy_look_ = 0;  ///< State::step
  State before_window_;
  double window_s_ = 0.0, output_interval_ = 0.0;
  double committed_step_ = 0.0;           ///< largest stable one from the last commit [s]
  std::int64_t windows_above_bound_ = 0;  ///< whose contacts turned out stiffer than foreseen, in spite of the safety
  std::vector<double> rail_foot_;         ///< at the end of the last window
  std::vector<double> start_positions_;   ///< of all particles at time 0, laid out like State::x
  bool relaxing_ = false, marching_ = false;
};

}  // namespace qdem
