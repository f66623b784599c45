#include "proto/session/run_directory.hpp"

#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "proto/error.hpp"

namespace proto {

RunDirectory::RunDirectory(const std::string& path)
    : path_(std::filesystem::absolute(path).lexically_normal().string()), socket_path_(path_ + "/coupler") {
  constexpr std::size_t longest = sizeof(sockaddr_un::sun_path) - 1;
  if (socket_path_.size() > longest)
    throw Error(ExitCode::cannot_create,
                "the path of the run's socket has " + std::to_string(socket_path_.size()) + " characters, " +
                    std::to_string(longest) + " are possible",
                socket_path_, "use a shorter directory, e.g. below $XDG_RUNTIME_DIR or /tmp");
  created_ = mkdir(path_.c_str(), S_IRWXU) == 0;
  if (!created_ && errno != EEXIST)
    throw Error(ExitCode::cannot_create, std::string("the run's directory cannot be created: ") + std::strerror(errno),
                path_);
  struct stat status {};
  const bool ours = lstat(path_.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
                    (status.st_mode & 0777) == S_IRWXU;
  if (!ours)
    throw Error(ExitCode::cannot_create, "the run's directory is open to others", path_,
                "give one of your own with mode 0700, or one that does not exist");
}

RunDirectory::~RunDirectory() {
  unlink(socket_path_.c_str());
  if (created_) rmdir(path_.c_str());
}

}  // namespace proto
