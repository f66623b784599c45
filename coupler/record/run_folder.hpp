// The folder that a run writes to.
#pragma once

#include <string>

namespace coupler {

/// The output folder of one run, locked against a second run for its life.
class RunFolder {
 public:
  /// Creates `out` (or `runs/<case_name>-<YYYYmmdd-HHMMSS>` when `out` is empty), parents included.
  /// Throws proto::Error (cannot_create) when it cannot be created, is not empty, or is in use by another run.
  RunFolder(const std::string& out, const std::string& case_name);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }  ///< absolute
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
  int lock_ = -1;
};

}  // namespace coupler
