// libFuzzer's target: the decoder on any bytes as a payload with a right hash, and as they are. tests/README.md says
// how.
#include "proto/error.hpp"
#include "proto/wire/codec.hpp"
#include "proto/wire/frame.hpp"

namespace {

void try_decoding(proto::Span<const std::uint8_t> frame) {
  try {
    proto::encode(proto::decode(frame));
  } catch (const proto::Error&) {  // refused, as it should be
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const proto::Span<const std::uint8_t> bytes(data, size);
  try_decoding(bytes);
  try_decoding(proto::make_frame(bytes));
  return 0;
}
