#include "proto/session/curve_keys.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "proto/error.hpp"

namespace proto {
namespace {

constexpr std::size_t key_length = 40;
constexpr std::size_t largest_file = 4096;
const std::string remake = "make the keys anew with 'coupler keys'";

/// A file descriptor that is closed at the end.
class File {
 public:
  File(const std::string& path, int flags, mode_t mode = 0) : fd_(open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, const std::string& text) {
  return write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

[[noreturn]] void refuse_creation(const std::string& path) {
  throw Error(ExitCode::cannot_create, std::string("the file cannot be written: ") + std::strerror(errno), path);
}

void write_new_file(const std::string& path, const std::string& text, mode_t mode) {
  const File file(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, mode);
  if (file.fd() < 0 && errno == EEXIST)
    throw Error(ExitCode::cannot_create, "there is a key already", path, "remove it to make another one");
  if (file.fd() < 0 || !write_all(file.fd(), text)) refuse_creation(path);
}

/// The text of an open file, at most `largest_file` bytes of it.
std::string text_of(const File& file, const std::string& path) {
  if (file.fd() < 0)
    throw Error(ExitCode::missing_input, std::string("the key cannot be read: ") + std::strerror(errno), path,
                "'coupler keys' makes keys");
  std::string text(largest_file, '\0');
  const auto n = read(file.fd(), text.data(), text.size());
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  return text;
}

/// The key behind `name = "`.
std::string key_in(const std::string& text, const std::string& name, const std::string& path) {
  const auto begin = text.find(name + " = \"");
  const auto key = begin == std::string::npos ? "" : text.substr(begin + name.size() + 4, key_length);
  std::uint8_t binary[32];
  if (key.size() != key_length || !zmq_z85_decode(binary, key.c_str()))
    throw Error(ExitCode::bad_data, "the file holds no " + name, path, remake);
  return key;
}

void refuse_open_file(const File& file, const std::string& path) {
  struct stat status {};
  if (file.fd() < 0) return;
  const bool ours = fstat(file.fd(), &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid();
  if (!ours) throw Error(ExitCode::bad_data, "the secret key is no file of this user", path, "copy it to one of yours");
  if (status.st_mode & 077)
    throw Error(ExitCode::bad_data, "others may read the secret key", path, "chmod 600 it, if nobody has read it");
}

}  // namespace

bool needs_keys(const std::string& address) {
  const std::string loopback = "tcp://127.";
  if (address.rfind("ipc://", 0) == 0 || address.rfind("inproc://", 0) == 0) return false;
  if (address.rfind(loopback, 0) != 0) return true;
  // A name may begin like that too, and a second address may follow.
  const auto end = address.find_first_not_of("0123456789.", loopback.size());
  return end != std::string::npos && address[end] != ':';
}

KeyPair make_key_pair() {
  char public_key[key_length + 1], secret_key[key_length + 1];
  if (zmq_curve_keypair(public_key, secret_key) != 0)
    throw Error(ExitCode::os_error, std::string("no keys can be made: ") + zmq_strerror(zmq_errno()), "libzmq",
                "it has to be built with CURVE, as Debian's is");
  return {public_key, secret_key};
}

void write_key_pair(const std::string& folder, const std::string& name, const KeyPair& keys) {
  const std::string public_line = "curve\n    public-key = \"" + keys.public_key + "\"\n";
  const std::string path = folder + "/" + name + ".key";
  write_new_file(path + "_secret", public_line + "    secret-key = \"" + keys.secret_key + "\"\n", 0600);
  write_new_file(path, public_line, 0644);
}

std::string read_public_key(const std::string& path) {
  return key_in(text_of(File(path, O_RDONLY), path), "public-key", path);
}

KeyPair read_key_pair(const std::string& path) {
  const File file(path, O_RDONLY);
  refuse_open_file(file, path);
  const auto text = text_of(file, path);
  const KeyPair keys{key_in(text, "public-key", path), key_in(text, "secret-key", path)};
  char derived[key_length + 1];
  if (zmq_curve_public(derived, keys.secret_key.c_str()) != 0 || keys.public_key != derived)
    throw Error(ExitCode::bad_data, "public and secret key do not belong together", path, remake);
  return keys;
}

void write_private_file(const std::string& path, const std::string& text) {
  const std::string unfinished = path + ".tmp";
  unlink(unfinished.c_str());
  const File file(unfinished, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  if (file.fd() < 0 || !write_all(file.fd(), text) || std::rename(unfinished.c_str(), path.c_str()) != 0)
    refuse_creation(path);
}

}  // namespace proto
