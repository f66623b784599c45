// A case file in memory that is changed key by key, and what its readers ask; private to this folder.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "proto/case/case_schema.hpp"
#include "proto/case/key_schema.hpp"

namespace proto {

/// What one reader asked of one case.
struct Reading {
  std::vector<KeyNote> notes;
  bool failed = false;
};

/// A case, changed by values that JSON Schema allows.
class Probe {
 public:
  explicit Probe(toml::table document) : document_(std::move(document)) {}

  bool has(const KeyNote& key) const;
  /// Whether the key is there with a value that its schema allows.
  bool fits(const KeyNote& key) const;
  /// Sets the key to `value`; sections that are missing are made.
  void set(const KeyNote& key, const Schema& value);

  Reading read(const CaseReader& reader) const;

 private:
  toml::table document_;
};

/// Whether the choices of `schema` are names of the case's own.
bool is_open(const Schema& schema);

/// A value that `schema` allows; 0.5 where it says nothing.
Schema some_value(const Schema& schema);

}  // namespace proto
