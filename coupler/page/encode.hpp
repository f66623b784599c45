// Numbers and texts in the form in which a page can carry them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace coupler::page {

/// RFC 4648, section 4, with padding.
std::string base64(const void* data, std::size_t size);

/// Values as multiples of a common step: value = step * integer, |integer| <= 32767; not_a_number stands for NaN and
/// infinity. The error of a value is at most half a step, and the step is the largest magnitude over 32767.
struct Quantised {
  static constexpr std::int16_t not_a_number = -32768;
  double step = 0.0;
  std::vector<std::int16_t> values;
};
Quantised quantise(const std::vector<double>& values);

/// {"step", "i16": base64}; little-endian.
nlohmann::json quantised_json(const std::vector<double>& values);
/// base64 of the values as little-endian float32.
nlohmann::json float_json(const std::vector<double>& values);
/// base64 of little-endian uint32.
nlohmann::json index_json(const std::vector<std::uint32_t>& values);

/// Length of base64 of `n_bytes`.
inline std::size_t base64_length(std::size_t n_bytes) {
  return (n_bytes + 2) / 3 * 4;
}

/// The text of `data` for a script element of a page: ASCII only, without <, > and &, so that no content can end the
/// element or begin a comment. Bytes that are no UTF-8 become U+FFFD; NaN becomes null.
std::string script_text(const nlohmann::json& data);

}  // namespace coupler::page
