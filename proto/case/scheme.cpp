#include "proto/case/scheme.hpp"

#include <algorithm>

namespace proto {

const std::vector<std::string>& scheme_names() {
  static const std::vector<std::string> names{"R1", "R2", "E0", "E1", "E2", "implicit", "one_way", "GC", "PH"};
  return names;
}

const std::string& name_of(Scheme scheme) {
  return scheme_names()[static_cast<std::size_t>(scheme)];
}

Scheme scheme_of(const std::string& name) {
  const auto& names = scheme_names();
  return static_cast<Scheme>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool uses_robin(Scheme scheme) {
  return scheme == Scheme::robin_explicit || scheme == Scheme::robin_corrected || scheme == Scheme::one_way;
}

bool needs_rollback(Scheme scheme) {
  return scheme == Scheme::robin_corrected || scheme == Scheme::implicit || is_rigid(scheme);
}

bool is_rigid(Scheme scheme) {
  return scheme == Scheme::rigid_per_step || scheme == Scheme::rigid_per_window;
}

bool can_switch(Scheme from, Scheme to) {
  const auto alone = [](Scheme scheme) { return scheme == Scheme::one_way || is_rigid(scheme); };
  return !alone(from) && !alone(to) && uses_robin(from) == uses_robin(to);
}

double expected_order(Scheme scheme) {
  const bool first =
      scheme == Scheme::parallel_staggered || scheme == Scheme::serial_staggered || scheme == Scheme::rigid_per_step;
  return first ? 1.0 : 2.0;
}

}  // namespace proto
