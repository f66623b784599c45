#include "coupler/record/run_folder.hpp"

#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <thread>

#include "proto/error.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& problem, const std::string& path, const std::string& advice = {}) {
  throw proto::Error(proto::ExitCode::cannot_create, problem, path, advice);
}

std::string default_folder(const std::string& case_name) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  const std::string base = "runs/" + case_name + "-" + stamp;
  std::string path = base;
  for (int i = 2; fs::exists(path); ++i) path = base + "-" + std::to_string(i);
  return path;
}

}  // namespace

RunFolder::RunFolder(const std::string& out, const std::string& case_name) : RunFolder() {
  path_ = fs::absolute(out.empty() ? default_folder(case_name) : out).lexically_normal().string();
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) fail("cannot create the output folder (" + error.message() + ")", path_);
  lock();
  if (!fs::is_empty(path_, error) || error)
    fail("the output folder is not empty", path_, "give another --out, or remove what is in it");
}

RunFolder RunFolder::reopen(const std::string& path) {
  RunFolder folder;
  folder.path_ = fs::absolute(path).lexically_normal().string();
  if (!fs::is_directory(folder.path_))
    throw proto::Error(proto::ExitCode::missing_input, "there is no folder of a run", folder.path_);
  folder.lock();
  return folder;
}

bool RunFolder::in_use(const std::string& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return false;
  const bool taken = flock(folder, LOCK_SH | LOCK_NB) != 0;
  close(folder);
  return taken;
}

void RunFolder::lock() {
  // The lock is on the folder itself: it leaves no file behind and ends with the process, however that ends.
  lock_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) fail(std::string("cannot open the output folder (") + strerror(errno) + ")", path_);
  // More than once: in_use() holds it for an instant.
  for (int tries = 0; flock(lock_, LOCK_EX | LOCK_NB) != 0; ++tries) {
    if (tries == 5) fail("another run is writing to this folder", path_, "give another --out");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

RunFolder::~RunFolder() {
  if (lock_ >= 0) close(lock_);
}

}  // namespace coupler
