#include "coupler/supervise/last_words.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace coupler {

std::string last_words(const std::string& path) {
  constexpr std::streamoff tail = 4096;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  file.seekg(std::max<std::streamoff>(0, static_cast<std::streamoff>(file.tellg()) - tail));
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last.substr(0, 400);
}

}  // namespace coupler
