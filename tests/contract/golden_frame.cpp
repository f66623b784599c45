// The bytes on the wire, as every participant ever built against protocol 1 writes and reads them.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "proto/wire/codec.hpp"
#include "tests/support/sample_messages.hpp"

using namespace proto;

namespace {

struct Golden {
  Message message;
  std::string hex;
};

Message result(std::optional<double> residual, std::optional<double> largest_step_s = {}) {
  Result body{Phase::initialise, 3, 0, 0.25, {}, residual, largest_step_s};
  body.data.set(field::impulse, {1.0, -2.5, 0.125});
  return {0x1122334455667788u, 6, 5, body};
}

const std::vector<Golden> golden = {
    {{0x1122334455667788u, 5, 0, Commit{258}},  // 1.0
     "514643315000000034fa8808e16dd8571c000000514643310000000000000e0022000c0014000000070008000e0000000000"
     "000a200000008877665544332211050000000000000000000000000006000c000400060000000201000000000000"},
    {result({}),  // 1.0
     "51464331b0000000b83d2fba331e63681c000000514643310000000000000e0026000c0014001c00070008000e0000000000"
     "00092c00000088776655443322110600000000000000050000000000000000000e001c00000008000000100004000e000000"
     "180000000300000000000000000000000000d03f00000000010000000c00000008000c000400080008000000080000001000"
     "000007000000696d70756c73650003000000000000000000f03f00000000000004c0000000000000c03f"},
    {result(4e-3),  // 1.1
     "51464331b8000000ee9484254d3f60a21c000000514643310000000000000e0024000c0014001c00070008000e0000000000"
     "00092c0000008877665544332211060000000000000005000000000000001000240000000800000010000400180010000000"
     "200000000300000000000000000000000000d03ffca9f1d24d62703f00000000010000000c00000008000c00040008000800"
     "0000080000001000000007000000696d70756c73650003000000000000000000f03f00000000000004c0000000000000c03f"},
    {result(4e-3, 5e-7),  // 1.2
     "51464331c800000014d485f7b79c1f2c1c000000514643310000000000000e002a000c0014001c00070008000e0000000000"
     "00093400000088776655443322110600000000000000050000000000000000000000000012002c0000000800000010000400"
     "1800200012000000280000000300000000000000000000000000d03ffca9f1d24d62703f8dedb5a0f7c6a03e000000000100"
     "00000c00000008000c000400080008000000080000001000000007000000696d70756c73650003000000000000000000f03f"
     "00000000000004c0000000000000c03f"},
};

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
  for (const auto& [message, hex] : golden) EXPECT_EQ(hexadecimal(encode(message)), hex);
}

TEST(GoldenFrame, is_still_read) {
  for (const auto& [message, hex] : golden) EXPECT_TRUE(decode(bytes_of(hex)) == message) << hex;
}

TEST(Schema, its_hash_belongs_to_this_protocol_version) {
  EXPECT_EQ(protocol_major, 1u);
  EXPECT_EQ(protocol_minor, 3u);
  EXPECT_EQ(schema_hash(), 8804289083056681821u)
      << "the schema changed: raise the version, and say so in proto/README.md";
}

}  // namespace
