#include "coupler/launch/exec_child.hpp"

#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>

#include "proto/error.hpp"

namespace coupler {

std::vector<std::string> exec_child_command(const std::string& helper, int parent_pid,
                                            const std::vector<std::string>& command) {
  std::vector<std::string> result{helper, exec_child_subcommand, std::to_string(parent_pid)};
  result.insert(result.end(), command.begin(), command.end());
  return result;
}

void exec_child(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3)
    throw proto::Error(proto::ExitCode::usage, "too few arguments", exec_child_subcommand, "it is not for people");
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (std::to_string(getppid()) != arguments[1])
    throw proto::Error(proto::ExitCode::unavailable, "the coupler is gone", arguments[2]);
  std::vector<char*> pointers;
  for (std::size_t i = 2; i < arguments.size(); ++i) pointers.push_back(const_cast<char*>(arguments[i].c_str()));
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  throw proto::Error(proto::ExitCode::os_error, std::string("cannot start the program (") + strerror(errno) + ")",
                     arguments[2]);
}

}  // namespace coupler
