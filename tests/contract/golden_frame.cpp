// The bytes on the wire, as every participant ever built against protocol 1.0 writes and reads them.
#include <gtest/gtest.h>

#include <string>

#include "proto/wire/codec.hpp"
#include "tests/support/sample_messages.hpp"

using namespace proto;

namespace {

const Message golden_message = {0x1122334455667788u, 5, 0, Commit{258}};
const std::string golden_hex =
    "514643315000000034fa8808e16dd8571c000000514643310000000000000e0022000c0014000000070008000e0000000000000a"
    "200000008877665544332211050000000000000000000000000006000c000400060000000201000000000000";

std::string hexadecimal(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const auto byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

TEST(GoldenFrame, is_still_written) {
  EXPECT_EQ(hexadecimal(encode(golden_message)), golden_hex);
}

TEST(GoldenFrame, is_still_read) {
  EXPECT_TRUE(decode(bytes_of(golden_hex)) == golden_message);
}

TEST(Schema, its_hash_belongs_to_this_protocol_version) {
  EXPECT_EQ(protocol_major, 1u);
  EXPECT_EQ(protocol_minor, 0u);
  EXPECT_EQ(schema_hash(), 11661546224345613681u)
      << "the schema changed: raise the version, and say so in proto/README.md";
}

}  // namespace
