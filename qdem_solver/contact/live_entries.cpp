#include "qdem_solver/contact/live_entries.hpp"

#include <algorithm>
#include <numeric>

namespace qdem {

void LiveEntries::clear(std::size_t n_entries, std::size_t n_bodies) {
  n_entries_ = static_cast<std::int64_t>(n_entries);
  n_in_chunk_.assign((n_entries + chunk_size - 1) / chunk_size, 0);
  chunks_.resize(n_in_chunk_.size() * chunk_size);
  all_.clear(), second_.clear();
  first_offsets_.assign(n_bodies + 1, 0), second_offsets_.assign(n_bodies + 1, 0);
}

std::pair<std::int64_t, std::int64_t> LiveEntries::chunk(std::int64_t number) const {
  return {number * chunk_size, std::min((number + 1) * chunk_size, n_entries_)};
}

void LiveEntries::sort_by_body(const std::vector<ContactKey>& keys) {
  all_.clear();
  std::fill(first_offsets_.begin(), first_offsets_.end(), 0);
  std::fill(second_offsets_.begin(), second_offsets_.end(), 0);
  for (std::int64_t chunk = 0; chunk < n_chunks(); ++chunk) {
    const std::int64_t* first = &chunks_[chunk * chunk_size];
    all_.insert(all_.end(), first, first + n_in_chunk_[chunk]);
  }
  for (const std::int64_t entry : all_) {
    ++first_offsets_[keys[entry].body_a + 1];
    if (!keys[entry].is_plane()) ++second_offsets_[keys[entry].body_b + 1];
  }
  std::partial_sum(first_offsets_.begin(), first_offsets_.end(), first_offsets_.begin());
  std::partial_sum(second_offsets_.begin(), second_offsets_.end(), second_offsets_.begin());
  second_.resize(second_offsets_.back());
  // Filled from behind, so that the ends of the bodies' ranges turn into their begins.
  for (auto entry = all_.rbegin(); entry != all_.rend(); ++entry) {
    if (!keys[*entry].is_plane()) second_[--second_offsets_[keys[*entry].body_b + 1]] = *entry;
  }
  std::copy(second_offsets_.begin() + 1, second_offsets_.end(), second_offsets_.begin());
  second_offsets_.back() = static_cast<std::int64_t>(second_.size());
}

}  // namespace qdem
