// The rail and the wheel as the implicit side of a coupled run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem_solver/model/settings.hpp"
#include "fem_solver/output/fem_record.hpp"
#include "fem_solver/rail/rail_model.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "proto/case/coupling.hpp"
#include "proto/session/participant.hpp"

namespace fem {

/// Everything the FEM side reads from a case.
struct FemCase {
  proto::CaseFile file;
  proto::Coupling coupling;
  std::vector<proto::RailSeat> seats;
  FemSettings fem;
  WheelSettings wheel;
};

/// Reads and checks the common sections, `[fem]` and `[wheel]`. Throws proto::Error (config, missing_input, bad_data).
FemCase read_fem_case(const std::string& path);

/// Figures of rail and model for the summary.
std::vector<proto::Fact> model_facts(const RailModel& rail, const FemSettings& settings);

/// Adapter from the protocol to WheelTrack. Rolls back to the last commit.
class FemParticipant : public proto::Participant {
 public:
  /// `program`: name of the executable; `name`: in the session. Throws what `build` throws.
  FemParticipant(FemCase input, std::string program, std::string name, const RailBuilder& build,
                 WheelBuilder build_wheel = mass_wheel);

  void watch(proto::Progress& progress) override { progress_ = &progress; }
  std::string build_id() const override;
  std::string name() const override { return name_; }
  proto::Capabilities capabilities() const override;
  proto::Interface describe() override;
  proto::Configured configure(const proto::Configure& request) override;
  proto::FieldSet advance(const proto::Advance& request, proto::Progress& progress) override;
  /// WheelTrack::residual().
  std::optional<double> residual() override { return track_->residual(); }
  void commit(const proto::Commit& request) override;
  void rollback(const proto::Rollback& request) override;
  proto::FieldSet start() override;
  std::uint64_t save(const proto::Save& request) override;
  void restore(const proto::Restore& request) override;
  std::vector<proto::Fact> finish() override;

 private:
  void bump() const;
  WindowInput window_input(const proto::FieldSet& data) const;
  proto::FieldSet motion() const;
  template <class... Saved>
  void open_record(Saved&... saved);
  /// Everything but the file's own counts.
  void exchange(proto::StateArchive& archive);

  FemCase input_;
  std::string program_, name_;
  proto::Progress* progress_ = nullptr;
  std::unique_ptr<RailModel> rail_;
  WheelBuilder build_wheel_;
  proto::LoadMode mode_ = proto::LoadMode::robin;
  std::unique_ptr<WheelTrack> track_;
  std::unique_ptr<FemRecord> record_;
  std::string output_directory_;
  double window_s_ = 0.0;
  RunState committed_;
  Eigen::VectorXd force_used_;  // of the last window, per interface value [N]
  proto::Phase phase_ = proto::Phase::initialise;
  bool relaxed_ = false;  // a window of the initialise phase has set the static state
  double largest_contact_ = 0.0, smallest_contact_ = 0.0, lowest_wheel_ = 0.0;
};

}  // namespace fem
