// The QDEM solver as a participant of a coupled run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/session/participant.hpp"
#include "qdem_solver/participant/bed_record.hpp"
#include "qdem_solver/participant/track_bed.hpp"

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
  RecordSettings record_settings() const;
  /// The state of the march: what the end's hash is of.
  void exchange(proto::StateArchive& archive);

  proto::CaseFile file_;
  BedSource source_;
  std::string name_, out_;
  proto::Progress* progress_ = nullptr;
  std::unique_ptr<TrackBed> bed_;
  EnergyWatch energy_;
  std::unique_ptr<BedRecord> record_;
  State before_window_;
  double window_s_ = 0.0, output_interval_ = 0.0;
  double committed_step_ = 0.0;           ///< largest stable one from the last commit [s]
  bool above_bound_ = false;              ///< the step of the window just advanced
  std::int64_t windows_above_bound_ = 0;  ///< whose contacts turned out stiffer than foreseen, in spite of the safety
  std::vector<double> rail_foot_;         ///< at the end of the last window
  bool relaxing_ = false, marching_ = false;
};

}  // namespace qdem
