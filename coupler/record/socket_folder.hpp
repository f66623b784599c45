// The short-lived folder that a run's socket lives in.
#pragma once

#include <string>

namespace coupler {

/// A fresh folder of mode 0700 under $XDG_RUNTIME_DIR or /tmp (short: ipc paths end at 107 bytes), locked by flock for
/// the object's life and removed at its end.
///
/// A coupler killed with SIGKILL cannot remove its own; the lock dies with it. So the next run removes what this user's
/// dead couplers left: folders of that name and mode that nobody has locked. Only a socket is ever deleted from one, a
/// folder that holds anything else stays.
class SocketFolder {
 public:
  SocketFolder();  ///< throws proto::Error (cannot_create)
  ~SocketFolder();
  SocketFolder(const SocketFolder&) = delete;
  SocketFolder& operator=(const SocketFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int lock_ = -1;
};

}  // namespace coupler
