// What a reader asks a section for, in the words of JSON Schema; private to this folder.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"

namespace proto {

using Schema = nlohmann::json;

/// One question of a reader. `place` is the section's with indices ("qdem.material[1]"), `schema` what the key's value
/// must be, empty for the mere question whether the key is there.
struct KeyNote {
  std::string place, key;
  Schema schema;
  bool required = false;
};

Schema number_schema(const Range& range);
Schema integer_schema(const Range& range);
Schema text_schema(const std::vector<std::string>& choices = {});  ///< no choices: any text
Schema list_schema(const Schema& item, std::size_t length = 0);    ///< 0: of any length
Schema type_schema(const char* type);                              ///< "boolean", "object"

/// `schema` of a key that may be left out.
template <class Value>
Schema with_default(Schema schema, const Value& fallback) {
  schema["default"] = fallback;
  return schema;
}

}  // namespace proto
