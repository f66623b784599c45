// Which entries of a candidate list carry a force, in the order in which the bodies gather them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Filled chunk by chunk, each by one thread; then sorted by body. The order within a body is that of the list, whoever
/// filled the chunks.
class LiveEntries {
 public:
  using Entries = proto::Span<const std::int64_t>;

  /// Forgets everything; the list has `n_entries`.
  void clear(std::size_t n_entries, std::size_t n_bodies);

  std::int64_t n_chunks() const { return static_cast<std::int64_t>(n_in_chunk_.size()); }
  /// Entries [first, last) of the list that are a chunk's.
  std::pair<std::int64_t, std::int64_t> chunk(std::int64_t number) const;
  /// Where the live entries of a chunk go, in ascending order; end_chunk() says how many there are.
  std::int64_t* begin_chunk(std::int64_t number) { return &chunks_[number * chunk_size]; }
  void end_chunk(std::int64_t number, std::int64_t n_live) { n_in_chunk_[number] = n_live; }
  void sort_by_body(const std::vector<ContactKey>& keys);

  Entries all() const { return {all_.data(), all_.size()}; }
  Entries first_of(int body) const { return part(all_, first_offsets_, body); }       ///< whose body_a it is
  Entries second_of(int body) const { return part(second_, second_offsets_, body); }  ///< whose body_b it is

 private:
  static constexpr std::int64_t chunk_size = 256;
  static Entries part(const std::vector<std::int64_t>& entries, const std::vector<std::int64_t>& offsets, int body) {
    return {entries.data() + offsets[body], static_cast<std::size_t>(offsets[body + 1] - offsets[body])};
  }

  std::int64_t n_entries_ = 0;
  std::vector<std::int64_t> chunks_, n_in_chunk_;
  std::vector<std::int64_t> all_, second_;                    ///< by body_a, which is the list's order; by body_b
  std::vector<std::int64_t> first_offsets_, second_offsets_;  ///< CSR
};

}  // namespace qdem
