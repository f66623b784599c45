#include "coupler/record/interface_hash.hpp"

#include <xxhash.h>

namespace coupler {

void InterfaceHash::add(const WindowRecord& record) {
  const auto take = [this](const void* bytes, std::size_t size) { value_ = XXH3_64bits_withSeed(bytes, size, value_); };
  take(&record.window, sizeof record.window);
  take(&record.sub_cycles, sizeof record.sub_cycles);
  for (const auto* values :
       {&record.rail_displacement, &record.rail_velocity, &record.sleeper_displacement, &record.sleeper_velocity,
        &record.force_robin, &record.force_used, &record.impulse, &record.pad_work})
    take(values->data(), values->size() * sizeof(double));
}

}  // namespace coupler
