// Paths in case files that name several files.
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "proto/case/node_reader.hpp"
#include "proto/case/section_data.hpp"
#include "proto/error.hpp"

namespace proto {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& folder, const std::string& pattern) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const bool matches = fnmatch(pattern.c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0;
    if (matches && entry.is_regular_file(failure)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string file_ending(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::vector<std::string> Section::matching_files(const std::string& key,
                                                 const std::vector<std::string>& endings) const {
  const fs::path written = text(key);
  const auto path = (fs::path(data_->document->folder) / written).lexically_normal();
  std::error_code failure;
  const bool is_folder = fs::is_directory(path, failure);
  const auto found = is_folder ? files_of(path, "*") : files_of(path.parent_path(), path.filename().string());
  std::vector<std::string> result;
  for (const fs::path& file : found) {
    const bool known = std::count(endings.begin(), endings.end(), file_ending(file.string())) > 0;
    if (known) result.push_back(file.string());
    if (!known && !is_folder) fail(key, "'" + file.string() + "' ends on none of: " + joined(endings));
  }
  if (result.empty()) {
    throw Error(ExitCode::missing_input,
                is_folder ? "the folder '" + path.string() + "' has no file that ends on one of: " + joined(endings)
                          : "there is no file '" + path.string() + "'",
                data_->where(key), "relative paths start at the folder of the case file");
  }
  return result;
}

}  // namespace proto
