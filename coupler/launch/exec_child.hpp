// The coupler's hidden sub-command that stands between fork and a participant's program.
//
// Why: a child must die with the coupler even when the coupler is killed with SIGKILL, which no handler sees. Linux
// does that by prctl(PR_SET_PDEATHSIG), which has to be called in the child itself and survives execve; libuv offers no
// hook between its fork and its exec. So libuv starts this program again as
//
//     coupler exec-child PARENT_PID PROGRAM [ARGUMENT...]
//
// which asks for the signal, makes sure that its parent is still the one that started it (the parent may have died
// before prctl was called), and becomes PROGRAM.
#pragma once

#include <string>
#include <vector>

namespace coupler {

inline constexpr const char* exec_child_subcommand = "exec-child";

/// The command line that makes `helper` become `command`.
std::vector<std::string> exec_child_command(const std::string& helper, int parent_pid,
                                            const std::vector<std::string>& command);

/// The sub-command; `arguments` as in exec_child_command() from the sub-command on. Does not return on success.
/// Throws proto::Error: usage for too few arguments, unavailable when the parent is gone, os_error when exec fails.
[[noreturn]] void exec_child(const std::vector<std::string>& arguments);

}  // namespace coupler
