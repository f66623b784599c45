// Damaged copies of a message's bytes, from a seeded generator.
#pragma once

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace tests {

using Payload = std::vector<std::uint8_t>;

/// Makes variants of `seeds`: bits and bytes changed, words with the values that offsets and lengths break at, pieces
/// cut out, doubled, taken from another seed.
class FrameMutator {
 public:
  FrameMutator(const std::vector<Payload>& seeds, std::uint64_t number) : seeds_(seeds), random_(number) {}

  Payload next() {
    Payload bytes = seeds_[below(seeds_.size())];
    for (std::size_t n = 1 + below(4); n > 0 && !bytes.empty(); --n) change(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  void change(Payload& bytes) {
    const std::size_t at = below(bytes.size()), rest = bytes.size() - at;
    switch (below(6)) {
      case 0:
        bytes[at] ^= static_cast<std::uint8_t>(1u << below(8));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(random_());
        break;
      case 2:
        put_word(bytes, at);
        break;
      case 3:
        bytes.resize(at);
        break;
      case 4:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin(),
                     bytes.begin() + static_cast<std::ptrdiff_t>(1 + below(bytes.size())));
        break;
      default: {
        const auto& other = seeds_[below(seeds_.size())];
        for (std::size_t i = 0, n = 1 + below(rest); i < n && i < other.size(); ++i)
          bytes[at + i] = other[(at + i) % other.size()];
      }
    }
  }

  void put_word(Payload& bytes, std::size_t at) {
    constexpr std::uint32_t words[] = {0, 1, 4, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffc, 0x7ff00000};
    const std::uint32_t word = words[below(8)];
    at -= at % 4;
    if (at + 4 <= bytes.size()) std::memcpy(&bytes[at], &word, 4);
  }

  const std::vector<Payload>& seeds_;
  std::mt19937_64 random_;
};

}  // namespace tests
