// The private directory of a run's socket.
#pragma once

#include <string>

namespace proto {

/// Owner of `path`/coupler. File permissions are the authentication of ipc, so nobody else may enter the directory.
class RunDirectory {
 public:
  /// Creates `path` with mode 0700, or takes an existing one that belongs to this user with that mode.
  /// Throws proto::Error (cannot_create).
  explicit RunDirectory(const std::string& path);
  /// Removes the socket's file, and the directory if it was created here and is empty.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::string& socket_path() const { return socket_path_; }

 private:
  std::string path_, socket_path_;
  bool created_ = false;
};

}  // namespace proto
