#include "coupler/page/encode.hpp"

#include <algorithm>
#include <cmath>

namespace coupler::page {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the page reads little-endian numbers");

std::string base64(const void* data, std::size_t size) {
  static const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve(base64_length(size));
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t n = std::min<std::size_t>(3, size - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? letters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Quantised quantise(const std::vector<double>& values) {
  constexpr double most = 32767.0;
  double largest = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  Quantised result;
  result.step = largest / most;
  result.values.reserve(values.size());
  for (const double value : values) {
    if (!std::isfinite(value)) {
      result.values.push_back(Quantised::not_a_number);
    } else {
      result.values.push_back(largest == 0 ? std::int16_t{0}
                                           : static_cast<std::int16_t>(std::lround(value / largest * most)));
    }
  }
  return result;
}

nlohmann::json quantised_json(const std::vector<double>& values) {
  const auto quantised = quantise(values);
  return {{"step", quantised.step}, {"i16", base64(quantised.values.data(), 2 * quantised.values.size())}};
}

nlohmann::json float_json(const std::vector<double>& values) {
  const std::vector<float> narrow(values.begin(), values.end());
  return base64(narrow.data(), sizeof(float) * narrow.size());
}

nlohmann::json index_json(const std::vector<std::uint32_t>& values) {
  return base64(values.data(), sizeof(std::uint32_t) * values.size());
}

std::string script_text(const nlohmann::json& data) {
  const std::string plain = data.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (const char c : plain) {
    switch (c) {
      case '<':
        text += "\\u003c";
        break;
      case '>':
        text += "\\u003e";
        break;
      case '&':
        text += "\\u0026";
        break;
      default:
        text += c;
    }
  }
  return text;
}

}  // namespace coupler::page
