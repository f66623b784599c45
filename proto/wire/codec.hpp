// Messages to bytes and back. The only place that sees FlatBuffers.
//
// A frame is a 16-byte prefix (magic "QFC1", 32-bit size of the payload, XXH3-64 of the payload) and the FlatBuffer.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/span.hpp"
#include "proto/wire/messages.hpp"

namespace proto {

inline constexpr std::uint32_t protocol_major = 1;
inline constexpr std::uint32_t protocol_minor = 3;
inline constexpr std::uint32_t oldest_protocol_minor = 2;  ///< of a participant that a coupler still takes

/// XXH3-64 of the schema's text, fixed at build time.
std::uint64_t schema_hash();

/// The frame of a message. Never fails for a well-formed value.
std::vector<std::uint8_t> encode(const Message& message);

/// The message in a frame. Copies to aligned memory, checks size and hash, verifies the FlatBuffer (depth 8,
/// 4096 tables), refuses an unknown body, and refuses numbers that are not finite, naming field and index.
/// Throws proto::Error with ExitCode::protocol (ExitCode::numerics for values that are not finite).
Message decode(Span<const std::uint8_t> frame);

}  // namespace proto
