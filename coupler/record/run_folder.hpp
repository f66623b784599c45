// The folder that a run writes to.
#pragma once

#include <string>
#include <utility>

namespace coupler {

/// The output folder of one run, locked against a second run for its life.
class RunFolder {
 public:
  /// Creates `out` (or `runs/<case_name>-<YYYYmmdd-HHMMSS>` when `out` is empty), parents included.
  /// Throws proto::Error (cannot_create) when it cannot be created, is not empty, or is in use by another run.
  RunFolder(const std::string& out, const std::string& case_name);
  /// The folder of an earlier run, to go on in it. Throws proto::Error: missing_input (there is none), cannot_create
  /// (in use by another run).
  static RunFolder reopen(const std::string& path);
  /// Whether a run holds the folder now.
  static bool in_use(const std::string& path);
  RunFolder(RunFolder&& other) noexcept : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }  ///< absolute
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  RunFolder() = default;
  void lock();

  std::string path_;
  int lock_ = -1;
};

}  // namespace coupler
