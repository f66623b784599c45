// A look at a TOML text before the parser sees it.
#pragma once

#include <string>

namespace proto {

/// Throws a config error naming line and column for keys of more than 64 dotted parts and for brackets nested deeper
/// than 64: the parser recurses on both, and a long key ends toml++ 3.3.0 with a stack overflow.
void refuse_hostile_toml(const std::string& text, const std::string& path);

}  // namespace proto
