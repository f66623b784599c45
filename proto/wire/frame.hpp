// The 16 bytes before every FlatBuffer: magic "QFC1", payload size, XXH3-64 of the payload; all little endian.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/span.hpp"

namespace proto {

inline constexpr std::size_t frame_prefix_bytes = 16;

/// Prefix and payload in one array.
std::vector<std::uint8_t> make_frame(Span<const std::uint8_t> payload);

/// The payload of a frame, copied to memory aligned for doubles. Throws proto::Error (protocol) unless magic, size and
/// hash are right.
std::vector<std::uint8_t> open_frame(Span<const std::uint8_t> frame);

}  // namespace proto
