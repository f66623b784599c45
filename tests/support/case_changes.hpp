// Variants of a case file's text.
#pragma once

#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace tests {

using CaseChanges = std::vector<std::pair<std::string, std::string>>;

/// `text` with `key = value` in the place of the first line of each key. A test that names a key that is not there
/// fails.
inline std::string with_changes(std::string text, const CaseChanges& changes) {
  for (const auto& [key, value] : changes) {
    const std::regex line("(^|\n)" + key + " = [^\n]*");
    EXPECT_TRUE(std::regex_search(text, line)) << key;
    text = std::regex_replace(text, line, "$1" + key + " = " + value, std::regex_constants::format_first_only);
  }
  return text;
}

}  // namespace tests
