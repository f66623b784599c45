// Runs through `coupler run`: three real processes. The split oscillator as a case for them.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/processes.hpp"

namespace tests {

inline const std::string bin_folder = HOUSE_BIN_DIR;

/// Command of tests/support/relaxing_participant.cpp as a case has it.
inline std::string relaxing_command(const std::string& side, const std::string& fault = "none") {
  return "[\"" + bin_folder + "/../test_bin/relaxing_participant\", \"--side\", \"" + side + "\", \"--fault\", \"" +
         fault + "\"]";
}

/// A variant of the case split_oscillator. The texts are inserted as they are.
struct OscillatorCase {
  std::string scheme = "R1";
  double window_s = 0.025, duration_s = 4.0;
  double largest_step_s = 0.0;  ///< of the explicit side; 0: its own bound
  double initial_displacement_m = 1.0;
  double pad_damping_ns_per_m = 0.2;
  double sleeper_displacement_m = -0.5, sleeper_velocity_m_per_s = 0.3;
  std::string qdem_command = R"(["oscillator_participant", "participant", "--side", "explicit"])";
  std::string fem_command = R"(["oscillator_participant", "participant", "--side", "implicit"])";
  std::string more_coupling;  ///< further lines of [coupling]

  std::string text() const {
    std::ostringstream s;
    s.precision(17);
    s << "[coupling]\nscheme = \"" << scheme << "\"\nwindow_s = " << window_s << "\nduration_s = " << duration_s
      << "\nqdem_command = " << qdem_command << "\nfem_command = " << fem_command << "\n"
      << more_coupling << "\n[[rail_seat]]\nname = \"seat\"\norigin_m = [0.0, 0.0, 0.0]\n"
      << "half_lengths_m = [0.1, 0.1]\ncells = [1, 1]\nstiffness_n_per_m = [0.0, 0.0, 10.0]\n"
      << "damping_ns_per_m = [0.0, 0.0, " << pad_damping_ns_per_m << "]\n"
      << "[oscillator.implicit]\nmass_kg = 1.0\nground_stiffness_n_per_m = 1.0\ninitial_displacement_m = "
      << initial_displacement_m << "\ninitial_velocity_m_per_s = 0.0\n"
      << "[oscillator.explicit]\nmass_kg = 0.5\nground_stiffness_n_per_m = 4.0\ninitial_displacement_m = "
      << sleeper_displacement_m << "\ninitial_velocity_m_per_s = " << sleeper_velocity_m_per_s
      << "\nlargest_step_s = " << largest_step_s << "\n";
    return s.str();
  }
};

/// `coupler ARGUMENTS` in a folder of its own, in the background.
class CoupledRun {
 public:
  explicit CoupledRun(const std::string& case_text) { std::ofstream(case_path()) << case_text; }
  ~CoupledRun() {
    if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
  }

  std::string case_path() const { return folder_.file("case.toml"); }
  std::string out() const { return folder_.file("out"); }

  void start(std::vector<std::string> arguments = {}) {
    if (arguments.empty()) arguments = {"run", case_path(), "--out", out()};
    std::fflush(nullptr);  // or the child writes again what is still in the buffers
    pid_ = fork();
    if (pid_ != 0) return;
    const std::string program = bin_folder + "/coupler";
    std::vector<const char*> pointers{program.c_str()};
    for (const auto& argument : arguments) pointers.push_back(argument.c_str());
    pointers.push_back(nullptr);
    if (!freopen(folder_.file("stdout").c_str(), "w", stdout) || !freopen(folder_.file("stderr").c_str(), "w", stderr))
      _exit(126);
    execv(program.c_str(), const_cast<char**>(pointers.data()));
    _exit(127);
  }

  /// Waits at most `limit_s`; the exit code, 128 + signal when a signal ended it, nothing when it still runs.
  std::optional<int> wait(double limit_s = 60.0) {
    int status = 0;
    if (!becomes_true([&] { return waitpid(pid_, &status, WNOHANG) == pid_; }, limit_s)) return std::nullopt;
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// Runs to the end.
  std::optional<int> run(std::vector<std::string> arguments = {}) {
    start(std::move(arguments));
    return wait();
  }

  int pid() const { return pid_; }
  std::string message() const { return read_text(folder_.file("stderr")); }
  std::string table() const { return read_text(folder_.file("stdout")); }
  std::string log() const { return read_text(out() + "/run.log"); }
  nlohmann::json summary() const { return nlohmann::json::parse(read_text(out() + "/summary.json"), nullptr, false); }

  /// Process of a participant, from the log; 0 before it was started.
  int participant(const std::string& name) const {
    std::smatch match;
    const auto text = log();
    const bool found = std::regex_search(text, match, std::regex("started " + name + ": .*\\(process (\\d+)\\)"));
    return found ? std::stoi(match[1]) : 0;
  }

  /// True once the log holds `part`.
  bool await_log(const std::string& part, double limit_s = 20.0) const {
    return becomes_true([&] { return log().find(part) != std::string::npos; }, limit_s);
  }
  /// True once windows are being run.
  bool await_march() const { return await_log("marching"); }

  /// Running processes of the run: those whose command line names its folder.
  int n_processes() const { return count_processes(folder_.path()); }

 private:
  TemporaryFolder folder_;
  int pid_ = 0;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace tests
