// Reading one value of a case file; private to this folder.
#pragma once

#include <string>
#include <vector>

#include "proto/case/section_data.hpp"

namespace proto {

/// "a whole number", "a table", ...
std::string type_in_words(const toml::node& node);

/// "a, b, c".
std::string joined(const std::vector<std::string>& names);

/// Reads one node of a section; every failure is a config error that names the node's own place.
class NodeReader {
 public:
  NodeReader(const Section::Data& data, const toml::node& node, std::string key)
      : data_(data), node_(node), key_(std::move(key)) {}

  double number(const Range& range) const;  ///< finite and in the range; a whole number is one
  std::int64_t integer(const Range& range) const;
  bool boolean() const;
  std::string text() const;
  std::string choice(const std::vector<std::string>& choices) const;

  /// The values of an array, each read by `read(NodeReader)`; `what` names them in the error.
  template <class Read>
  auto elements(Read read, const char* what) const {
    const auto* array = node_.as_array();
    if (!array) fail(std::string("an array of ") + what + " is wanted, found " + type_in_words(node_));
    std::vector<decltype(read(*this))> values;
    for (const auto& element : *array)
      values.push_back(read(NodeReader(data_, element, key_ + "[" + std::to_string(values.size()) + "]")));
    return values;
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& advice = {}) const;

 private:
  void check(const Range& range, double value) const;

  const Section::Data& data_;
  const toml::node& node_;
  std::string key_;
};

}  // namespace proto
