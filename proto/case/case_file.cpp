#include "proto/case/case_file.hpp"

#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "proto/case/parse_guard.hpp"
#include "proto/case/section_data.hpp"
#include "proto/error.hpp"

namespace proto {
namespace {

constexpr std::uintmax_t largest_file = 1 << 20;
constexpr const char* case_folder_key = "case_folder";

std::string read_text(const std::filesystem::path& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status))
    throw Error(ExitCode::missing_input, "there is no such case file", path.string());
  if (!std::filesystem::is_regular_file(status))
    throw Error(ExitCode::missing_input, "the case is not a file", path.string(), "give the path of a case.toml");
  const auto size = std::filesystem::file_size(path, failure);
  if (failure || size > largest_file)
    throw Error(ExitCode::config, "the case file is larger than 1 MiB", path.string(),
                "put tables into files of their own");
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream)
    throw Error(ExitCode::missing_input, "the case file cannot be read", path.string(), "check its permissions");
  return text.str();
}

toml::table parse(const std::string& text, const std::string& path) {
  refuse_hostile_toml(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const auto begin = error.source().begin;
    throw Error(ExitCode::config, "the case file is not valid TOML: " + std::string(error.description()),
                path + ":" + std::to_string(begin.line) + ":" + std::to_string(begin.column));
  }
}

/// `case_folder`, or the folder of the file.
std::string folder_of(const CaseDocument& document) {
  const auto* node = document.root.get(case_folder_key);
  if (!node) return std::filesystem::path(document.path).parent_path().string();
  const auto begin = node->source().begin;
  const auto where =
      document.path + ":" + std::to_string(begin.line) + ":" + std::to_string(begin.column) + ": " + case_folder_key;
  const auto folder = node->value<std::string>();
  if (!folder || !std::filesystem::path(*folder).is_absolute())
    throw Error(ExitCode::config, "an absolute path is wanted", where, "remove it: relative paths start at the file");
  std::error_code failure;
  if (!std::filesystem::is_directory(*folder, failure))
    throw Error(ExitCode::missing_input, "there is no folder '" + *folder + "'", where);
  return *folder;
}

}  // namespace

CaseFile::CaseFile(std::shared_ptr<Section::Data> root) : root_(std::move(root)) {}

CaseFile CaseFile::load(const std::string& path) {
  auto document = std::make_shared<CaseDocument>();
  document->path = std::filesystem::absolute(path).lexically_normal().string();
  document->text = read_text(document->path);
  document->root = parse(document->text, document->path);
  document->folder = folder_of(*document);
  auto root = std::make_shared<Section::Data>();
  root->table = &document->root;
  root->document = std::move(document);
  return CaseFile(std::move(root));
}

Section CaseFile::section(const std::string& name) const {
  return Section(root_->child(name));
}

std::vector<Section> CaseFile::sections(const std::string& name) const {
  std::vector<Section> result;
  for (const auto& data : root_->children(name)) result.push_back(Section(data));
  return result;
}

const std::string& CaseFile::path() const {
  return root_->document->path;
}
const std::string& CaseFile::text() const {
  return root_->document->text;
}

std::string CaseFile::name() const {
  const std::filesystem::path file = path();
  return file.filename() == "case.toml" ? file.parent_path().filename().string() : file.stem().string();
}

std::uint64_t CaseFile::hash() const {
  return XXH3_64bits(text().data(), text().size());
}

void CaseFile::refuse_unknown_sections(const std::vector<std::string>& known) const {
  for (const auto& [key, node] : *root_->table) {
    const std::string name(key.str());
    if (name == case_folder_key || std::find(known.begin(), known.end(), name) != known.end()) continue;
    const auto nearest = nearest_name(name, known);
    throw Error(ExitCode::config, "unknown section", root_->where(key.source(), name),
                nearest.empty() ? "remove it" : "did you mean '" + nearest + "'?");
  }
}

}  // namespace proto
