#include "proto/wire/frame.hpp"

#include <xxhash.h>

#include <cstring>
#include <string>

#include "proto/error.hpp"

namespace proto {
namespace {

constexpr char magic[] = {'Q', 'F', 'C', '1'};
constexpr std::size_t largest_payload = 0x7fffff00;  // FlatBuffers' offsets are signed 32-bit numbers

/// Byte by byte, so that the wire does not depend on the machine.
template <class Integer>
void put(std::uint8_t* bytes, Integer value) {
  for (std::size_t i = 0; i < sizeof value; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

template <class Integer>
Integer take(const std::uint8_t* bytes) {
  Integer value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) value |= static_cast<Integer>(bytes[i]) << (8 * i);
  return value;
}

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(ExitCode::protocol, "malformed frame: " + problem, "", "see 'Frame' in proto/README.md");
}

}  // namespace

std::vector<std::uint8_t> make_frame(Span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> frame(frame_prefix_bytes + payload.size());
  std::memcpy(frame.data(), magic, sizeof magic);
  put(&frame[4], static_cast<std::uint32_t>(payload.size()));
  put(&frame[8], static_cast<std::uint64_t>(XXH3_64bits(payload.data(), payload.size())));
  std::memcpy(frame.data() + frame_prefix_bytes, payload.data(), payload.size());
  return frame;
}

std::vector<std::uint8_t> open_frame(Span<const std::uint8_t> frame) {
  if (frame.size() < frame_prefix_bytes) refuse("shorter than its 16-byte prefix");
  if (std::memcmp(frame.data(), magic, sizeof magic) != 0) refuse("it does not begin with QFC1");
  const auto payload = frame.sub(frame_prefix_bytes, frame.size() - frame_prefix_bytes);
  if (payload.size() > largest_payload || take<std::uint32_t>(frame.data() + 4) != payload.size())
    refuse("its size field does not agree with the number of bytes received");
  if (take<std::uint64_t>(frame.data() + 8) != XXH3_64bits(payload.data(), payload.size()))
    refuse("its hash does not agree with its bytes");
  return {payload.begin(), payload.end()};  // operator new aligns to 16 bytes
}

}  // namespace proto
