// The JSON Schema of a case file, from the very calls that read it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"

namespace proto {

/// Reads some sections of a case; what it throws is no matter here.
using CaseReader = std::function<void(const CaseFile&)>;

/// A name that nobody has declared: choices that hold it are names of the case's own, and any text is one.
inline constexpr const char* name_of_ones_own = "x";

/// JSON Schema (2020-12, as text) of everything that `readers` ask a case for: types, ranges, choices, defaults, and
/// which keys no reader goes without.
///
/// How: the readers read each of the `seeds`, whose missing keys are added with values that their questions allow, and
/// everything they ask is noted. Then each key that was asked for is added, each choice is taken, each array of tables
/// gets an element, one at a time, and the readers read again, until no question is new. Seeds (TOML) hold what can
/// only be known: that a material is called "stone", which keys go together. A key that a reader asks for only in the
/// presence of two others is not found, unless the one leads to the other.
std::string case_schema(const std::vector<CaseReader>& readers, const std::vector<std::string>& seeds = {""});

}  // namespace proto
