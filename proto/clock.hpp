// Wall time.
#pragma once

#include <chrono>

namespace proto {

/// Wall time since `begin` [s].
inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace proto
