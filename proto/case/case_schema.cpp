#include "proto/case/case_schema.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "proto/case/probe.hpp"

namespace proto {
namespace {

constexpr int most_additions = 200;  // to one case; a reader that wants more goes in a circle
constexpr std::size_t most_probes = 20000;

/// "qdem.material[1]" -> "qdem.material".
std::string without_indices(const std::string& place) {
  std::string name;
  bool inside = false;
  for (const char c : place) {
    inside = (inside || c == '[') && c != ']';
    if (!inside && c != ']') name += c;
  }
  return name;
}

/// What is known of one section, from all its readings.
struct SectionNotes {
  std::map<std::string, Schema> keys;
  std::set<std::string> asked_optional;
  /// By reader: keys that it asked for as required in every section of this name that it read to the end.
  std::map<std::size_t, std::set<std::string>> required;
};

/// One schema for two questions about the same key.
Schema merged(const Schema& one, const Schema& other) {
  if (one.empty() || one == other) return other;
  if (other.empty()) return one;
  Schema result = one;
  if (is_open(other)) result = other;
  // A default that depends on other keys is none.
  if (one.contains("default") && other.contains("default") && one["default"] != other["default"])
    result.erase("default");
  else if (other.contains("default"))
    result["default"] = other["default"];
  return result;
}

class Explorer {
 public:
  Explorer(const std::vector<CaseReader>& readers) : readers_(readers) {}

  void explore(const std::string& seed) {
    add(Probe(toml::parse(seed)));
    for (; !waiting_.empty() && visited_.size() < most_probes; waiting_.pop_front()) {
      const auto [probe, notes] = std::move(waiting_.front());
      for (const auto& note : notes) vary(probe, note);
    }
  }

  Schema section(const std::string& name) const {
    Schema result = type_schema("object");
    result["additionalProperties"] = false;
    const auto found = sections_.find(name);
    if (found == sections_.end()) return result;
    for (const auto& [key, schema] : found->second.keys) result["properties"][key] = of_key(name, key, schema);
    std::set<std::string> required;
    for (const auto& of_reader : found->second.required)
      for (const auto& key : of_reader.second)
        if (!found->second.asked_optional.count(key)) required.insert(key);
    if (!required.empty()) result["required"] = required;
    return result;
  }

 private:
  using Notes = std::vector<KeyNote>;

  Schema of_key(const std::string& section_name, const std::string& key, Schema schema) const {
    const auto full = section_name.empty() ? key : section_name + "." + key;
    if (schema.value("type", "") == "object") return section(full);
    if (schema.contains("items") && schema["items"].value("type", "") == "object") schema["items"] = section(full);
    if (is_open(schema)) schema.erase("enum");
    return schema;
  }

  /// Adds what the readers miss as long as that leads on, and keeps the case for variations.
  void add(Probe probe) {
    Notes all;
    bool changed = true;
    for (int i = 0; changed && i < most_additions; ++i) {
      changed = false;
      all.clear();
      for (std::size_t r = 0; r < readers_.size(); ++r) {
        const auto reading = probe.read(readers_[r]);
        learn(r, reading);
        all.insert(all.end(), reading.notes.begin(), reading.notes.end());
        if (!reading.failed || reading.notes.empty()) continue;
        const auto& last = reading.notes.back();
        if (last.schema.empty() || probe.fits(last)) continue;
        probe.set(last, some_value(last.schema));
        changed = true;
      }
    }
    waiting_.emplace_back(std::move(probe), std::move(all));
  }

  void learn(std::size_t reader, const Reading& reading) {
    std::map<std::string, std::set<std::string>> required;  // by place
    for (const auto& note : reading.notes) {
      auto& section = sections_[without_indices(note.place)];
      auto& schema = section.keys[note.key];
      schema = merged(schema, note.schema);
      auto& of_place = required[note.place];
      if (note.required) of_place.insert(note.key);
      if (!note.required && !note.schema.empty()) section.asked_optional.insert(note.key);
    }
    if (reading.failed) return;
    for (const auto& [place, keys] : required) {
      auto& of_section = sections_[without_indices(place)].required;
      const auto [entry, is_new] = of_section.emplace(reader, keys);
      if (is_new) continue;
      std::set<std::string> both;
      std::set_intersection(keys.begin(), keys.end(), entry->second.begin(), entry->second.end(),
                            std::inserter(both, both.begin()));
      entry->second = both;
    }
  }

  /// One variation of a case for each thing that the key can be, if that was not tried yet.
  void vary(const Probe& probe, const KeyNote& note) {
    const bool chosen = note.schema.contains("enum") && !is_open(note.schema);
    std::vector<Schema> values;
    if (chosen)
      values = note.schema["enum"].get<std::vector<Schema>>();
    else if (!probe.has(note))
      values.push_back(some_value(known(note)));
    for (const auto& value : values) {
      if (!visited_.insert(without_indices(note.place) + "." + note.key + "=" + value.dump()).second) continue;
      Probe next = probe;
      next.set(note, value);
      add(std::move(next));
    }
  }

  /// What is known by now of the key.
  const Schema& known(const KeyNote& note) const {
    const auto& schema = sections_.at(without_indices(note.place)).keys.at(note.key);
    return schema;
  }

  const std::vector<CaseReader>& readers_;
  std::map<std::string, SectionNotes> sections_;
  std::deque<std::pair<Probe, Notes>> waiting_;
  std::set<std::string> visited_;
};

}  // namespace

std::string case_schema(const std::vector<CaseReader>& readers, const std::vector<std::string>& seeds) {
  Explorer explorer(readers);
  for (const auto& seed : seeds) explorer.explore(seed);
  auto schema = explorer.section("");
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  return schema.dump(2);
}

}  // namespace proto
