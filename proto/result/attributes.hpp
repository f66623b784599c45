// Named facts stored beside the data of a result file.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace proto {

/// A number or a text. Give texts as std::string, whole numbers as std::int64_t.
using Attribute = std::variant<double, std::int64_t, std::string>;
/// In the order in which they are written.
using Attributes = std::vector<std::pair<std::string, Attribute>>;

}  // namespace proto
