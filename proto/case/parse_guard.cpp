#include "proto/case/parse_guard.hpp"

#include "proto/error.hpp"

namespace proto {
namespace {

constexpr int limit = 64;

/// Index just behind the string that starts at `first` (a quote), triple-quoted ones included.
std::size_t skip_string(const std::string& text, std::size_t first) {
  const char quote = text[first];
  const bool basic = quote == '"';
  const bool triple = text.compare(first, 3, std::string(3, quote)) == 0;
  std::size_t at = first + (triple ? 3 : 1);
  while (at < text.size()) {
    if (basic && text[at] == '\\')
      at += 2;
    else if (!triple && (text[at] == quote || text[at] == '\n'))
      return at + 1;
    else if (triple && text.compare(at, 3, std::string(3, quote)) == 0)
      return at + 3;
    else
      ++at;
  }
  return text.size();
}

std::string place(const std::string& text, std::size_t at, const std::string& path) {
  std::size_t line = 1, line_begin = 0;
  for (std::size_t i = 0; i < at; ++i)
    if (text[i] == '\n') ++line, line_begin = i + 1;
  return path + ":" + std::to_string(line) + ":" + std::to_string(at - line_begin + 1);
}

}  // namespace

void refuse_hostile_toml(const std::string& text, const std::string& path) {
  int dots = 0, depth = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = skip_string(text, at);
      continue;
    }
    if (c == '#') {
      at = text.find('\n', at);
      if (at == std::string::npos) return;
      continue;
    }
    // Whatever cannot stand inside a key ends the run of dots.
    if (c == '.')
      ++dots;
    else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}')
      dots = 0;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (dots >= limit) throw Error(ExitCode::config, "a key of more than 64 dotted parts", place(text, at, path));
    if (depth > limit) throw Error(ExitCode::config, "brackets nested deeper than 64", place(text, at, path));
    ++at;
  }
}

}  // namespace proto
