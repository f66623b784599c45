#include "proto/case/node_reader.hpp"

#include <charconv>
#include <cmath>

#include "proto/error.hpp"

namespace proto {
namespace {

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string in_words(const Range& range) {
  const bool bounded = std::isfinite(range.highest);
  if (bounded && !range.lowest_excluded) return "between " + shortest(range.lowest) + " and " + shortest(range.highest);
  const std::string low = (range.lowest_excluded ? "greater than " : "at least ") + shortest(range.lowest);
  return bounded ? low + " and at most " + shortest(range.highest) : low;
}

bool holds(const Range& range, double value) {
  return (range.lowest_excluded ? value > range.lowest : value >= range.lowest) && value <= range.highest;
}

}  // namespace

std::string type_in_words(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

double NodeReader::number(const Range& range) const {
  if (!node_.is_number()) fail("a number is wanted, found " + type_in_words(node_));
  const double value = *node_.value<double>();
  if (!std::isfinite(value)) fail("a finite number is wanted, found " + shortest(value));
  check(range, value);
  return value;
}

std::int64_t NodeReader::integer(const Range& range) const {
  if (!node_.is_integer()) fail("a whole number is wanted, found " + type_in_words(node_));
  const std::int64_t value = **node_.as_integer();
  check(range, static_cast<double>(value));
  return value;
}

bool NodeReader::boolean() const {
  if (!node_.is_boolean()) fail("true or false is wanted, found " + type_in_words(node_));
  return **node_.as_boolean();
}

std::string NodeReader::text() const {
  if (!node_.is_string()) fail("a text is wanted, found " + type_in_words(node_));
  return **node_.as_string();
}

std::string NodeReader::choice(const std::vector<std::string>& choices) const {
  const auto value = text();
  for (const auto& name : choices)
    if (name == value) return value;
  const auto nearest = nearest_name(value, choices);
  fail("'" + value + "' is not one of: " + joined(choices), nearest.empty() ? "" : "did you mean '" + nearest + "'?");
}

void NodeReader::check(const Range& range, double value) const {
  if (!holds(range, value)) fail("the value must be " + in_words(range) + ", found " + shortest(value));
}

void NodeReader::fail(const std::string& problem, const std::string& advice) const {
  throw Error(ExitCode::config, problem, data_.where(node_.source(), key_), advice);
}

}  // namespace proto
