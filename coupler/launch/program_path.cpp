#include "coupler/launch/program_path.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "proto/error.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string own_path() {
  return fs::read_symlink("/proc/self/exe").string();
}

std::string find_program(const std::string& program, const std::string& where) {
  const auto folder = fs::path(own_path()).parent_path();
  if (program.find('/') != std::string::npos) {
    if (is_program(program)) return fs::absolute(program).string();
  } else {
    if (is_program(folder / program)) return (folder / program).string();
    std::istringstream entries(std::getenv("PATH") ? std::getenv("PATH") : "");
    for (std::string entry; std::getline(entries, entry, ':');)
      if (!entry.empty() && is_program(fs::path(entry) / program))
        return fs::absolute(fs::path(entry) / program).string();
  }
  throw proto::Error(proto::ExitCode::missing_input, "there is no program '" + program + "'", where,
                     "it is looked for in " + folder.string() + " and in PATH");
}

}  // namespace coupler
