#include "coupler/record/socket_folder.hpp"

#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "proto/error.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

const std::string name_pattern = "qdem-fem-XXXXXX";

std::string parent_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const bool usable = runtime && *runtime && access(runtime, W_OK) == 0 && strlen(runtime) < 60;
  return usable ? runtime : "/tmp";
}

/// Descriptor that holds the lock of a private folder of this user; -1 if it is none, gone, or locked by its owner.
int lock_folder(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return -1;
  struct stat opened {
  }, named{};
  const bool ours = fstat(fd, &opened) == 0 && opened.st_uid == geteuid() && (opened.st_mode & 0777) == S_IRWXU;
  // Who had the lock before may have removed the folder: then the descriptor is of nothing that has a name.
  if (ours && flock(fd, LOCK_EX | LOCK_NB) == 0 && lstat(path.c_str(), &named) == 0 && named.st_ino == opened.st_ino)
    return fd;
  close(fd);
  return -1;
}

/// Removes a folder that holds a socket at most. To be called with its lock.
void remove_folder(const std::string& path) {
  std::error_code ignored;
  const std::string socket = path + "/coupler";
  if (fs::is_socket(fs::symlink_status(socket, ignored))) unlink(socket.c_str());
  rmdir(path.c_str());
}

void remove_stale_folders(const std::string& parent) {
  std::error_code failure;
  const auto prefix = name_pattern.substr(0, name_pattern.find('X'));
  for (fs::directory_iterator entry(parent, failure), end; !failure && entry != end; entry.increment(failure)) {
    const auto path = entry->path().string(), name = entry->path().filename().string();
    if (name.size() != name_pattern.size() || name.compare(0, prefix.size(), prefix) != 0) continue;
    const int lock = lock_folder(path);
    if (lock < 0) continue;
    remove_folder(path);
    close(lock);
  }
}

}  // namespace

SocketFolder::SocketFolder() {
  const auto parent = parent_folder();
  remove_stale_folders(parent);
  // Between its making and its locking another run may take the folder for a stale one; then a second is made.
  for (int attempt = 0; lock_ < 0 && attempt < 10; ++attempt) {
    path_ = parent + "/" + name_pattern;
    if (!mkdtemp(path_.data())) break;
    lock_ = lock_folder(path_);
  }
  if (lock_ < 0)
    throw proto::Error(proto::ExitCode::cannot_create,
                       std::string("cannot create a folder for the socket (") + strerror(errno) + ")", path_);
}

SocketFolder::~SocketFolder() {
  remove_folder(path_);
  close(lock_);
}

}  // namespace coupler
