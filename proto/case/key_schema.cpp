#include "proto/case/key_schema.hpp"

#include <cmath>

namespace proto {
namespace {

/// Bounds of whole numbers are whole numbers.
template <class Number>
Schema bounded(const char* type, const Range& range) {
  Schema schema = type_schema(type);
  if (std::isfinite(range.lowest))
    schema[range.lowest_excluded ? "exclusiveMinimum" : "minimum"] = static_cast<Number>(range.lowest);
  if (std::isfinite(range.highest)) schema["maximum"] = static_cast<Number>(range.highest);
  return schema;
}

}  // namespace

Schema type_schema(const char* type) {
  return {{"type", type}};
}

Schema number_schema(const Range& range) {
  return bounded<double>("number", range);
}

Schema integer_schema(const Range& range) {
  return bounded<std::int64_t>("integer", range);
}

Schema text_schema(const std::vector<std::string>& choices) {
  Schema schema = type_schema("string");
  if (!choices.empty()) schema["enum"] = choices;
  return schema;
}

Schema list_schema(const Schema& item, std::size_t length) {
  Schema schema = type_schema("array");
  schema["items"] = item;
  if (length > 0) schema["minItems"] = schema["maxItems"] = length;
  return schema;
}

}  // namespace proto
