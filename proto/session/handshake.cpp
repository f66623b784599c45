#include "proto/session/handshake.hpp"

#include <sys/random.h>

#include <algorithm>

#include "proto/error.hpp"
#include "proto/wire/codec.hpp"

namespace proto {
namespace {

std::string hexadecimal(std::uint64_t value) {
  std::string digits(16, '0');
  for (std::size_t i = 0; i < digits.size(); ++i) digits[i] = "0123456789abcdef"[value >> (60 - 4 * i) & 15];
  return digits;
}

std::uint64_t random_bits() {
  std::uint64_t bits = 0;
  if (getrandom(&bits, sizeof bits, 0) != sizeof bits)
    throw Error(ExitCode::os_error, "the operating system gives no random numbers");
  return bits;
}

std::string version(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string random_token() {
  return hexadecimal(random_bits()) + hexadecimal(random_bits());
}

std::uint64_t random_session() {
  return random_bits() | 1;
}

std::string why_not_welcome(const Hello& hello, const Admission& admission, const std::string& token,
                            const std::vector<std::string>& taken) {
  if (hello.session_token != token) return "the session token is not the one of this run";
  if (hello.protocol_major != protocol_major || hello.protocol_minor < oldest_protocol_minor)
    return "it speaks protocol version " + version(hello.protocol_major, hello.protocol_minor) + ", the coupler " +
           version(protocol_major, protocol_minor);
  // Another minor version has a longer or shorter schema; of the same version there is one schema only.
  if (hello.protocol_minor == protocol_minor && hello.schema_hash != schema_hash())
    return "its schema has the hash " + hexadecimal(hello.schema_hash) + ", the coupler's " +
           hexadecimal(schema_hash());
  if (admission.case_hash && hello.case_hash != admission.case_hash)
    return "its case file has the hash " + hexadecimal(hello.case_hash) + ", the coupler's " +
           hexadecimal(admission.case_hash);
  if (!admission.names.empty() && !contains(admission.names, hello.name)) {
    const auto nearest = nearest_name(hello.name, admission.names);
    return "no participant of this run is called '" + hello.name + "'" +
           (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
  }
  if (contains(taken, hello.name)) return "the name '" + hello.name + "' is taken already";
  return {};
}

}  // namespace proto
