// One coupled run from the start of the participants to their end.
#pragma once

#include <spdlog/logger.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupler/app/case_input.hpp"
#include "coupler/app/run_judge.hpp"
#include "coupler/launch/children.hpp"
#include "coupler/mapping/mapped_side.hpp"
#include "coupler/record/checkpoint.hpp"
#include "coupler/record/coupling_record.hpp"
#include "coupler/record/frame_log.hpp"
#include "coupler/record/interface_hash.hpp"
#include "coupler/record/recorded_rail.hpp"
#include "coupler/record/run_folder.hpp"
#include "coupler/record/run_status.hpp"
#include "coupler/record/socket_folder.hpp"
#include "coupler/record/summary.hpp"
#include "coupler/report/progress.hpp"
#include "coupler/scheme/coupling_scheme.hpp"
#include "coupler/supervise/remote_side.hpp"
#include "coupler/supervise/supervisor.hpp"

namespace coupler {

enum class MarchEnd { complete, stopped_by_user, out_of_time };

/// The steps of a run, to be called in the order in which they are declared. `summary` and `status` are filled as the
/// run goes and are valid at any time, also after a throw. Every step throws proto::Error or Interrupted.
class CoupledRun {
 public:
  CoupledRun(const CaseInput& input, const RunFolder& folder, spdlog::logger& log, Summary& summary,
             StatusFile& status);
  /// Ends whatever still runs.
  ~CoupledRun();

  /// Every frame of the run goes to a file frames.log, or frames-1.log, ... when there are some. To be called first.
  void record_frames();
  /// Starts both participants and hands them endpoint and token.
  void start(int n_threads);
  /// Handshake, check of the interface, configuration, sub-cycles.
  void set_up();
  /// Coupled windows until the seat forces rest; nothing when the case has no initialise phase.
  void initialise();
  /// Ends the initialise phase and takes the initial values.
  void begin();
  /// In place of initialise() and begin(): all three go on from what they saved. Throws proto::Error (bad_data, config)
  /// when the set does not fit the case, or (unless `allowed` has "program") a participant is another program than the
  /// one that saved its state.
  void resume(const Checkpoint& set, const std::set<std::string>& allowed);
  /// The windows that are left. Stops early, with a checkpoint if the participants can save, between two windows: at
  /// the user's signal, or before `deadline`.
  MarchEnd march(std::optional<std::chrono::steady_clock::time_point> deadline);
  /// Closes participants and record.
  void finish();

  /// Tells the participants why, and ends them. Never throws.
  void abandon(int code, const std::string& text) noexcept;

  int stop_signal() const { return children_.stop_signal(); }
  /// What it is doing or did last: "set-up", "window 37".
  const std::string& stage() const { return supervisor_.stage(); }
  /// Whether this run has saved a set of its own.
  bool has_checkpoint() const { return checkpointed_window_ >= 0; }

 private:
  /// Puts the map between fem and the scheme when fem has points of its own.
  void map_rail(const proto::Interface& registered);
  void configure();
  /// Ends the initialise phase; a step that the explicit side names replaces `largest_step_s`.
  InterfaceState initial_values(std::optional<double>& largest_step_s);
  proto::Attributes record_attributes() const;
  void save(std::int64_t window);
  void check_builds(const Checkpoint& set, const std::set<std::string>& allowed) const;
  bool saves_at_all() const;
  bool save_is_due(std::int64_t window) const;
  void exchange(proto::StateArchive& archive);
  void add_window(const WindowRecord& record);
  void begin_phase(const char* name, std::int64_t n_windows);
  /// How far a phase is.
  struct WindowsDone {
    std::int64_t n;
    double window_s;
    std::vector<double> forces;  ///< of every seat in the last one [N]
  };
  /// Shows it on the console and in the status file.
  void show(Progress& progress, const WindowsDone& done, const std::string& note);
  void switch_scheme(proto::Scheme to);
  void account(const WindowRecord& record);
  void update_totals(std::int64_t n_windows);
  void update_wall_time();
  MarchEnd early_end(std::optional<std::chrono::steady_clock::time_point> deadline) const;

  const CaseInput& input_;
  std::vector<std::string> names_;  ///< of the participants
  const RunFolder& folder_;
  spdlog::logger& log_;
  Summary& summary_;
  StatusFile& status_;
  SocketFolder socket_folder_;
  proto::CouplerEndpoint endpoint_;
  Children children_;
  Supervisor supervisor_;
  RemoteSide qdem_, fem_;
  std::optional<RecordedRail> recorded_;  ///< in the place of fem
  std::optional<MappedSide> mapped_;      ///< around fem when that has points of its own
  Side* rail_;                            ///< fem, the mapped or the recorded one
  RunJudge judge_;
  std::vector<proto::PadLaw> laws_;
  std::optional<double> configured_step_s_, initialise_step_s_;  ///< largest of the explicit side [s]
  std::unique_ptr<CouplingScheme> scheme_;                       ///< of the march
  std::optional<CouplingRecord> record_;
  std::optional<FrameLog> frames_;
  InterfaceHash hash_;
  std::map<std::string, std::string> builds_;  ///< of the participants, by name
  CheckpointSlots slots_;
  bool can_save_;  ///< all participants offer it, and the scheme's windows are theirs
  std::int64_t next_window_ = 0;
  std::int64_t checkpointed_window_ = -1;  ///< of the last set that this run saved
  std::chrono::steady_clock::time_point last_save_;
  std::chrono::steady_clock::time_point begin_;
  double waited_in_start_up_s_ = 0.0;
};

}  // namespace coupler
