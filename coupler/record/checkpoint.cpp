#include "coupler/record/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "proto/error.hpp"
#include "proto/result/state_file.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int format_version = 1;
constexpr const char* slots[] = {"A", "B"};
constexpr const char* manifest_name = "manifest.json";

std::string hex(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

std::uint64_t hash_from(const std::string& text) {
  return std::stoull(text, nullptr, 16);
}

std::string text_of(const Manifest& manifest) {
  Json root{{"format", format_version},
            {"window", manifest.window},
            {"window_s", manifest.window_s},
            {"case_path", manifest.case_path},
            {"case_hash", hex(manifest.case_hash)},
            {"version", manifest.version},
            {"source", manifest.source}};
  for (const auto& [name, build] : manifest.builds) root["builds"][name] = build;
  for (const auto& [name, hash] : manifest.hashes) root["files"][name] = hex(hash);
  return root.dump(2) + "\n";
}

Manifest manifest_from(const Json& root) {
  if (root.at("format").get<int>() != format_version)
    throw proto::Error(proto::ExitCode::bad_data, fmt::format("format {}", root.at("format").dump()));
  Manifest manifest;
  manifest.window = root.at("window");
  manifest.window_s = root.at("window_s");
  manifest.case_path = root.at("case_path");
  manifest.case_hash = hash_from(root.at("case_hash"));
  manifest.version = root.at("version");
  manifest.source = root.at("source");
  if (root.contains("builds"))
    for (const auto& [name, build] : root.at("builds").items()) manifest.builds[name] = build;
  for (const auto& [name, hash] : root.at("files").items()) manifest.hashes[name] = hash_from(hash);
  return manifest;
}

}  // namespace

std::optional<Checkpoint> CheckpointSlots::read(const std::string& slot, std::vector<std::string>& problems) const {
  const std::string path = folder_ + "/" + slot + "/" + manifest_name;
  std::ifstream file(path);
  if (!file) return std::nullopt;
  try {
    return Checkpoint{folder_ + "/" + slot, manifest_from(Json::parse(file))};
  } catch (const std::exception& error) {
    problems.push_back(path + " cannot be used: " + error.what());
    return std::nullopt;
  }
}

std::vector<Checkpoint> CheckpointSlots::all(std::vector<std::string>& problems) const {
  std::vector<Checkpoint> sets;
  for (const char* slot : slots)
    if (auto set = read(slot, problems)) sets.push_back(std::move(*set));
  std::sort(sets.begin(), sets.end(),
            [](const Checkpoint& a, const Checkpoint& b) { return a.manifest.window > b.manifest.window; });
  return sets;
}

Checkpoint CheckpointSlots::begin() const {
  std::vector<std::string> ignored;
  const auto sets = all(ignored);
  const std::string newest = sets.empty() ? "" : sets.front().folder;
  Checkpoint next;
  for (const char* slot : slots)
    if (next.folder.empty() && folder_ + "/" + slot != newest) next.folder = folder_ + "/" + slot;
  std::error_code error;
  fs::create_directories(next.folder, error);
  if (!error) fs::remove(next.folder + "/" + manifest_name, error);
  if (error)
    throw proto::Error(proto::ExitCode::cannot_create, "cannot make room for a checkpoint (" + error.message() + ")",
                       next.folder);
  return next;
}

void CheckpointSlots::forget_later(const Checkpoint& set) const {
  std::vector<std::string> ignored;
  for (const auto& other : all(ignored))
    if (other.manifest.window > set.manifest.window) fs::remove(other.folder + "/" + manifest_name);
}

void CheckpointSlots::complete(const Checkpoint& set) {
  proto::write_text_file(set.folder + "/" + manifest_name, text_of(set.manifest));
}

std::optional<Checkpoint> CheckpointSlots::newest(std::vector<std::string>& problems) const {
  for (auto& set : all(problems)) {
    bool whole = !set.manifest.hashes.empty();
    for (const auto& [name, hash] : set.manifest.hashes) {
      std::error_code error;
      if (fs::exists(set.file(name), error) && proto::hash_of_file(set.file(name)) == hash) continue;
      problems.push_back(set.file(name) + " is missing or damaged");
      whole = false;
    }
    if (whole) return set;
  }
  return std::nullopt;
}

}  // namespace coupler
