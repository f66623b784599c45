#include "proto/result/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "proto/error.hpp"

namespace proto {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }
  bool close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

bool write_all(int descriptor, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return true;
}

void put(const std::string& path, const std::string& text, bool synced) {
  const std::string temporary = path + ".tmp";
  const auto fail = [&](ExitCode code, const std::string& action) {
    const std::string reason = std::strerror(errno);
    ::unlink(temporary.c_str());
    throw Error(code, "cannot " + action + " the file (" + reason + ")", path);
  };
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (file.number() < 0) fail(ExitCode::cannot_create, "create");
  const bool written = write_all(file.number(), text) && (!synced || ::fsync(file.number()) == 0);
  if (!written || !file.close()) fail(ExitCode::io_error, "write");
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail(ExitCode::io_error, "rename");
}

}  // namespace

void replace_text_file(const std::string& path, const std::string& text) {
  put(path, text, false);
}

void write_text_file(const std::string& path, const std::string& text) {
  put(path, text, true);
  // Without this the rename itself may be lost with the machine's power.
  const auto folder = std::filesystem::absolute(path).parent_path();
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number() >= 0) ::fsync(directory.number());
}

}  // namespace proto
