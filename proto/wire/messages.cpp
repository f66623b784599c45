#include "proto/wire/messages.hpp"

#include <algorithm>
#include <array>

#include "proto/error.hpp"

namespace proto {

void FieldSet::set(const std::string& name, std::vector<double> values) {
  for (auto& field : fields_) {
    if (field.name != name) continue;
    field.values = std::move(values);
    return;
  }
  fields_.push_back({name, std::move(values)});
}

bool FieldSet::has(const std::string& name) const {
  return std::any_of(fields_.begin(), fields_.end(), [&](const Field& field) { return field.name == name; });
}

const std::vector<double>& FieldSet::get(const std::string& name) const {
  for (const auto& field : fields_)
    if (field.name == name) return field.values;
  std::string present;
  for (const auto& field : fields_) present += (present.empty() ? "" : ", ") + field.name;
  throw Error(ExitCode::protocol, "the message has no field '" + name + "'", "fields sent: " + present,
              "see the field table of proto/README.md");
}

bool belongs_to_pad(const std::string& name, LoadMode mode) {
  if (mode != LoadMode::robin) return false;
  for (const char* of_pad : {field::sleeper_mean_displacement, field::sleeper_mean_velocity, field::force_carry,
                           field::force_robin, field::force_used})
    if (name == of_pad) return true;
  return false;
}

const char* name_of(const Body& body) {
  static constexpr std::array<const char*, std::variant_size_v<Body>> names = {
      "Hello",    "Welcome", "Reject", "Interface", "Configure", "Configured", "Start", "Advance", "Result", "Commit",
      "Rollback", "Save",    "Saved",  "Restore",   "Restored",  "Heartbeat",  "Fault", "Finish",  "Bye"};
  return names[body.index()];
}

}  // namespace proto
