#include "coupler/launch/children.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>
#include <uv.h>

#include <chrono>
#include <deque>

#include "coupler/launch/exec_child.hpp"
#include "proto/clock.hpp"
#include "proto/error.hpp"

extern char** environ;

namespace coupler {
namespace {

using Clock = std::chrono::steady_clock;

using proto::seconds_since;

void require(int status, const std::string& what) {
  if (status < 0) throw proto::Error(proto::ExitCode::os_error, what + ": " + uv_strerror(status));
}

/// Environment of a child: the coupler's own, `added` over it; never a folder from which HDF5 would load code.
std::vector<std::string> child_environment(const std::vector<std::pair<std::string, std::string>>& added) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry, key = text.substr(0, text.find('='));
    bool replaced = key == "HDF5_PLUGIN_PATH";
    for (const auto& [name, value] : added) replaced = replaced || key == name;
    if (!replaced) result.push_back(text);
  }
  for (const auto& [name, value] : added) result.push_back(name + "=" + value);
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (auto& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Append-only log, or the coupler's own stderr. Closed on scope exit.
class LogFile {
 public:
  explicit LogFile(const std::string& path) {
    if (path.empty()) return;
    fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (fd_ < 0) throw proto::Error(proto::ExitCode::cannot_create, strerror(errno), path);
  }
  ~LogFile() {
    if (fd_ >= 0) close(fd_);
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  int fd_or(int fallback) const { return fd_ >= 0 ? fd_ : fallback; }

 private:
  int fd_ = -1;
};

struct Child {
  uv_process_t process{};
  std::string name;
  int pid = 0;
  std::optional<ChildExit> exit;
};

}  // namespace

struct Children::Data {
  std::string helper;
  uv_loop_t loop{};
  uv_signal_t signals[3]{};
  std::deque<Child> children;  // addresses stay
  int stop_signal = 0, n_stop_signals = 0;

  static void on_signal(uv_signal_t* handle, int number) {
    auto* data = static_cast<Data*>(handle->data);
    data->stop_signal = number;
    ++data->n_stop_signals;
  }

  static void on_exit(uv_process_t* process, int64_t status, int signal) {
    auto* child = static_cast<Child*>(process->data);
    child->exit = ChildExit{child->name, static_cast<int>(status), signal};
    // What the child started and left behind is in its group.
    kill(-child->pid, SIGKILL);
    uv_close(reinterpret_cast<uv_handle_t*>(process), nullptr);
  }

  void kill_groups(int number) {
    for (auto& child : children)
      if (!child.exit) kill(-child.pid, number);
  }
};

std::string process_library_version() {
  return uv_version_string();
}

std::string ChildExit::text() const {
  if (signal == 0) return "exited with code " + std::to_string(code);
  return "was killed by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

Children::Children(std::string helper) : data_(std::make_unique<Data>()) {
  data_->helper = std::move(helper);
  require(uv_loop_init(&data_->loop), "cannot set up the event loop");
  const int numbers[3] = {SIGINT, SIGTERM, SIGHUP};
  for (int i = 0; i < 3; ++i) {
    uv_signal_init(&data_->loop, &data_->signals[i]);
    data_->signals[i].data = data_.get();
    uv_signal_start(&data_->signals[i], Data::on_signal, numbers[i]);
  }
  poll();  // the loop watches its descriptors only once it has run
}

Children::~Children() {
  stop(0.0);
  for (auto& child : data_->children)
    if (!child.exit) uv_close(reinterpret_cast<uv_handle_t*>(&child.process), nullptr);
  for (auto& handle : data_->signals) uv_close(reinterpret_cast<uv_handle_t*>(&handle), nullptr);
  uv_run(&data_->loop, UV_RUN_NOWAIT);
  uv_loop_close(&data_->loop);
}

void Children::start(const ChildSpec& spec) {
  auto& child = data_->children.emplace_back();
  child.name = spec.name;
  child.process.data = &child;
  auto arguments = exec_child_command(data_->helper, getpid(), spec.command);
  auto environment = child_environment(spec.environment);
  auto argument_pointers = pointers(arguments), environment_pointers = pointers(environment);

  const LogFile log(spec.log_path);
  uv_stdio_container_t stdio[3]{};
  stdio[0].flags = UV_IGNORE;
  for (int i : {1, 2}) {
    stdio[i].flags = UV_INHERIT_FD;
    stdio[i].data.fd = log.fd_or(i);
  }
  uv_process_options_t options{};
  options.file = data_->helper.c_str();
  options.args = argument_pointers.data();
  options.env = environment_pointers.data();
  options.stdio = stdio;
  options.stdio_count = 3;
  options.flags = UV_PROCESS_DETACHED;
  options.exit_cb = Data::on_exit;
  const int status = uv_spawn(&data_->loop, &child.process, &options);
  if (status < 0) {
    uv_close(reinterpret_cast<uv_handle_t*>(&child.process), nullptr);
    uv_run(&data_->loop, UV_RUN_NOWAIT);
    data_->children.pop_back();
    require(status, "cannot start " + spec.name + " (" + spec.command.front() + ")");
  }
  child.pid = child.process.pid;
  poll();
}

int Children::fd() const {
  return uv_backend_fd(&data_->loop);
}

void Children::poll() {
  uv_run(&data_->loop, UV_RUN_NOWAIT);
}

void Children::wait(double timeout_s) {
  pollfd descriptor{fd(), POLLIN, 0};
  ::poll(&descriptor, 1, static_cast<int>(timeout_s * 1e3));
  poll();
}

std::optional<ChildExit> Children::exit_of(const std::string& name) const {
  for (const auto& child : data_->children)
    if (child.name == name) return child.exit;
  return std::nullopt;
}

bool Children::running() const {
  for (const auto& child : data_->children)
    if (!child.exit) return true;
  return false;
}

int Children::pid_of(const std::string& name) const {
  for (const auto& child : data_->children)
    if (child.name == name) return child.pid;
  return 0;
}

int Children::stop_signal() const {
  return data_->stop_signal;
}
int Children::n_stop_signals() const {
  return data_->n_stop_signals;
}

void Children::stop(double grace_s) noexcept {
  poll();
  if (!running()) return;
  if (grace_s > 0.0) {
    // A stopped process takes no SIGTERM before it is continued.
    data_->kill_groups(SIGTERM);
    data_->kill_groups(SIGCONT);
    const auto start = Clock::now();
    while (running() && seconds_since(start) < grace_s) wait(0.02);
  }
  data_->kill_groups(SIGKILL);
  // A process that the kernel cannot end at once (a dead network disk) must not keep the coupler from its end.
  const auto killed = Clock::now();
  while (running() && seconds_since(killed) < 2.0) wait(0.02);
}

}  // namespace coupler
