// Child processes of a run: started in groups of their own, watched, and gone when the coupler is gone.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coupler {

/// What to start.
struct ChildSpec {
  std::string name;                                              ///< for messages
  std::vector<std::string> command;                              ///< absolute path of the program, arguments
  std::vector<std::pair<std::string, std::string>> environment;  ///< added to the coupler's own
  std::string log_path;                                          ///< takes stdout and stderr; empty: the coupler's own
};

/// How a child ended.
struct ChildExit {
  std::string name;
  int code = 0;    ///< exit code, meaningful when signal is 0
  int signal = 0;  ///< signal that killed it, or 0
  /// "exited with code 78" or "was killed by signal 9 (Killed)".
  std::string text() const;
};

/// Owns the children of one run and the signals that end it.
///
/// Each child leads a session and process group of its own, and dies with the coupler (README "Processes"). The
/// destructor kills whatever is left, groups included, so no exception path can leave a process behind.
/// Not thread safe; create and use on the main thread, one object per process.
class Children {
 public:
  /// `helper`: path of this program, which must answer the hidden sub-command of exec_child.hpp.
  /// Takes SIGINT, SIGTERM and SIGHUP over for its life. Throws proto::Error (os_error).
  explicit Children(std::string helper);
  ~Children();
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  /// Throws proto::Error: os_error (the process), cannot_create (its log).
  void start(const ChildSpec& spec);

  /// Descriptor that becomes readable when poll() has something to do.
  int fd() const;
  /// Handles what has happened since the last call, without waiting.
  void poll();
  /// Waits at most `timeout_s` for something to happen, then polls.
  void wait(double timeout_s);

  /// The exit of a child, once it is known; empty while it runs. Unknown names have never exited.
  std::optional<ChildExit> exit_of(const std::string& name) const;
  bool running() const;                       ///< true while any child runs
  int pid_of(const std::string& name) const;  ///< 0 if it was never started

  /// Signal that asked the coupler to stop, 0 if none; and how often one came.
  int stop_signal() const;
  int n_stop_signals() const;

  /// SIGTERM to every group, SIGKILL to what is left after `grace_s`; returns when all children are gone.
  void stop(double grace_s) noexcept;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Version of the process library (libuv).
std::string process_library_version();

}  // namespace coupler
