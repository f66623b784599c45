// Options of the participants that only tests start.
#pragma once

#include <string>

namespace tests {

/// What follows `name` on the command line; empty where it does not stand there.
inline std::string option(int argc, char** argv, const std::string& name) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i] == name) return argv[i + 1];
  return {};
}

}  // namespace tests
