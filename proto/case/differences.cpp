#include "proto/case/case_file.hpp"

#include <charconv>
#include <map>
#include <sstream>

#include "proto/case/section_data.hpp"

namespace proto {
namespace {

using Values = std::map<std::string, std::string>;

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string text_of(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return shortest(number->get());
  std::ostringstream text;
  if (const auto* list = node.as_array()) {
    for (const auto& member : *list) text << (text.tellp() > 0 ? ", " : "[") << text_of(member);
    text << (list->empty() ? "[]" : "]");
  } else {
    node.visit([&](const auto& value) { text << value; });
  }
  return text.str();
}

void flatten(const toml::node& node, const std::string& key, Values& values) {
  if (const auto* table = node.as_table()) {
    for (const auto& [name, member] : *table)
      flatten(member, key.empty() ? std::string(name.str()) : key + "." + std::string(name.str()), values);
  } else if (const auto* list = node.as_array(); list && list->is_array_of_tables()) {
    std::size_t i = 0;
    for (const auto& member : *list) flatten(member, key + "[" + std::to_string(i++) + "]", values);
  } else {
    values[key] = text_of(node);
  }
}

}  // namespace

std::vector<std::string> CaseFile::differences_to(const CaseFile& later) const {
  Values old_values, new_values;
  flatten(root_->document->root, "", old_values);
  flatten(later.root_->document->root, "", new_values);
  Values all = old_values;
  all.insert(new_values.begin(), new_values.end());
  std::vector<std::string> lines;
  const auto value_in = [](const Values& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("(none)") : found->second;
  };
  for (const auto& entry : all) {
    const auto was = value_in(old_values, entry.first), is = value_in(new_values, entry.first);
    if (was != is) lines.push_back(entry.first + ": " + was + " -> " + is);
  }
  return lines;
}

}  // namespace proto
