#include <filesystem>

#include "proto/case/node_reader.hpp"
#include "proto/case/section_data.hpp"
#include "proto/error.hpp"

namespace proto {
namespace {

std::optional<NodeReader> offered(Section::Data& data, const std::string& key) {
  data.asked.insert(key);
  const auto* node = data.find(key);
  if (!node) return {};
  return NodeReader(data, *node, key);
}

/// The same for a key of which it is known what it must be.
template <class MakeSchema>
std::optional<NodeReader> optional(Section::Data& data, const std::string& key, MakeSchema schema) {
  data.note(key, false, schema);
  return offered(data, key);
}

template <class MakeSchema>
NodeReader required(Section::Data& data, const std::string& key, MakeSchema schema) {
  data.note(key, true, schema);
  if (const auto reader = offered(data, key)) return *reader;
  std::vector<std::string> unread;  // a misspelt key is among those that nobody has asked for
  if (data.table)
    for (const auto& item : *data.table)
      if (!data.asked.count(std::string(item.first.str()))) unread.emplace_back(item.first.str());
  const auto nearest = nearest_name(key, unread);
  if (nearest.empty()) throw Error(ExitCode::config, "missing key", data.where(key), "add it");
  throw Error(ExitCode::config, "missing key '" + key + "', found '" + nearest + "'", data.where(nearest),
              "did you mean '" + key + "'?");
}

void check_length(const Section& section, const std::string& key, std::size_t found, std::size_t wanted) {
  if (wanted && found != wanted)
    section.fail(key, std::to_string(wanted) + " numbers are wanted, found " + std::to_string(found));
}

}  // namespace

std::string Section::Data::where(const toml::source_region& region, const std::string& key) const {
  std::string text = document->path;
  if (region.begin.line) text += ":" + std::to_string(region.begin.line) + ":" + std::to_string(region.begin.column);
  return text + ": " + full_name(key);
}

std::string Section::Data::where(const std::string& key) const {
  if (!table) return where(toml::source_region{}, key);
  for (const auto& item : *table)
    if (item.first.str() == key) return where(item.first.source(), key);
  return where(name.empty() ? toml::source_region{} : table->source(), key);
}

std::shared_ptr<Section::Data> Section::Data::child(const std::string& key) {
  note(key, false, [] { return type_schema("object"); });
  asked.insert(key);
  auto& entry = tables[key];
  if (entry) return entry;
  const auto* node = find(key);
  if (node && !node->is_table())
    throw Error(ExitCode::config, "a table is wanted, found " + type_in_words(*node), where(key),
                "write [" + full_name(key) + "]");
  entry = std::make_shared<Data>();
  entry->document = document;
  entry->table = node ? node->as_table() : nullptr;
  entry->name = full_name(key);
  entry->place = place_of(key);
  return entry;
}

const std::vector<std::shared_ptr<Section::Data>>& Section::Data::children(const std::string& key) {
  note(key, false, [] { return list_schema(type_schema("object")); });
  asked.insert(key);
  auto& entries = arrays[key];
  const auto* node = find(key);
  if (!entries.empty() || !node) return entries;
  const auto* array = node->as_array();
  if (!array || (!array->empty() && !array->is_homogeneous<toml::table>()))
    throw Error(ExitCode::config, "an array of tables is wanted", where(key), "write [[" + full_name(key) + "]]");
  for (const auto& element : *array) {
    entries.push_back(std::make_shared<Data>());
    entries.back()->document = document;
    entries.back()->table = element.as_table();
    entries.back()->name = full_name(key);
    entries.back()->place = place_of(key) + "[" + std::to_string(entries.size() - 1) + "]";
  }
  return entries;
}

Section::Section(std::shared_ptr<Data> data) : data_(std::move(data)) {}

bool Section::has(const std::string& key) const {
  return optional(*data_, key, [] { return Schema::object(); }).has_value();
}

double Section::number(const std::string& key, Range range) const {
  return required(*data_, key, [&] { return number_schema(range); }).number(range);
}

double Section::number_or(const std::string& key, double fallback, Range range) const {
  const auto reader = optional(*data_, key, [&] { return with_default(number_schema(range), fallback); });
  return reader ? reader->number(range) : fallback;
}

std::int64_t Section::integer(const std::string& key, Range range) const {
  return required(*data_, key, [&] { return integer_schema(range); }).integer(range);
}

std::int64_t Section::integer_or(const std::string& key, std::int64_t fallback, Range range) const {
  const auto reader = optional(*data_, key, [&] { return with_default(integer_schema(range), fallback); });
  return reader ? reader->integer(range) : fallback;
}

bool Section::boolean_or(const std::string& key, bool fallback) const {
  const auto reader = optional(*data_, key, [&] { return with_default(type_schema("boolean"), fallback); });
  return reader ? reader->boolean() : fallback;
}

std::string Section::text(const std::string& key) const {
  return required(*data_, key, [] { return text_schema(); }).text();
}

std::string Section::text_or(const std::string& key, const std::string& fallback) const {
  const auto reader = optional(*data_, key, [&] { return with_default(text_schema(), fallback); });
  return reader ? reader->text() : fallback;
}

std::string Section::choice(const std::string& key, const std::vector<std::string>& choices) const {
  return required(*data_, key, [&] { return text_schema(choices); }).choice(choices);
}

std::string Section::choice_or(const std::string& key, const std::string& fallback,
                               const std::vector<std::string>& choices) const {
  const auto reader = optional(*data_, key, [&] { return with_default(text_schema(choices), fallback); });
  return reader ? reader->choice(choices) : fallback;
}

std::vector<double> Section::numbers(const std::string& key, std::size_t length, Range range) const {
  const auto read = [&](const NodeReader& element) { return element.number(range); };
  const auto reader = required(*data_, key, [&] { return list_schema(number_schema(range), length); });
  const auto values = reader.elements(read, "numbers");
  check_length(*this, key, values.size(), length);
  return values;
}

std::vector<double> Section::numbers_or(const std::string& key, const std::vector<double>& fallback,
                                        Range range) const {
  const auto read = [&](const NodeReader& element) { return element.number(range); };
  const auto reader = optional(*data_, key, [&] { return with_default(list_schema(number_schema(range)), fallback); });
  return reader ? reader->elements(read, "numbers") : fallback;
}

std::vector<std::int64_t> Section::integers(const std::string& key, std::size_t length, Range range) const {
  const auto read = [&](const NodeReader& element) { return element.integer(range); };
  const auto reader = required(*data_, key, [&] { return list_schema(integer_schema(range), length); });
  const auto values = reader.elements(read, "whole numbers");
  check_length(*this, key, values.size(), length);
  return values;
}

std::vector<std::string> Section::texts_or(const std::string& key, const std::vector<std::string>& fallback) const {
  const auto reader = optional(*data_, key, [&] { return with_default(list_schema(text_schema()), fallback); });
  if (!reader) return fallback;
  return reader->elements([](const NodeReader& element) { return element.text(); }, "texts");
}

std::string Section::existing_path(const std::string& key) const {
  const std::filesystem::path written = text(key);
  const auto base = std::filesystem::path(data_->document->folder);
  const auto path = (written.is_absolute() ? written : base / written).lexically_normal();
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
    throw Error(ExitCode::missing_input, "there is no file '" + path.string() + "'", data_->where(key),
                "relative paths start at the folder of the case file");
  return path.string();
}

Section Section::section(const std::string& key) const {
  return Section(data_->child(key));
}

std::vector<Section> Section::sections(const std::string& key) const {
  std::vector<Section> result;
  for (const auto& data : data_->children(key)) result.push_back(Section(data));
  return result;
}

namespace {

/// Throws for a key of the table that nobody asked for: of several for the one that is most like a key that somebody
/// did ask for, because the others may be unknown for its sake (a "kind" that is misspelt).
void refuse_unknown(const Section::Data& data) {
  const toml::key* unknown = nullptr;
  std::string nearest;
  for (const auto& item : *data.table) {
    const std::string key(item.first.str());
    if (data.asked.count(key)) continue;
    const auto name = nearest_name(key, data.asked);
    const bool nearer = !name.empty() && (nearest.empty() || edit_distance(key, name) <
                                                                 edit_distance(std::string(unknown->str()), nearest));
    if (!unknown || nearer) unknown = &item.first, nearest = name;
  }
  if (!unknown) return;
  throw Error(ExitCode::config, "unknown key", data.where(unknown->source(), std::string(unknown->str())),
              nearest.empty() ? "valid keys: " + joined({data.asked.begin(), data.asked.end()})
                              : "did you mean '" + nearest + "'?");
}

}  // namespace

void Section::finish() const {
  if (data_->document->notes) return;  // a made-up case may hold keys that another choice needs
  if (data_->table) refuse_unknown(*data_);
  for (const auto& item : data_->tables) Section(item.second).finish();
  for (const auto& item : data_->arrays)
    for (const auto& data : item.second) Section(data).finish();
}

void Section::fail(const std::string& key, const std::string& problem, const std::string& advice) const {
  const auto* node = data_->find(key);
  throw Error(ExitCode::config, problem, node ? data_->where(node->source(), key) : data_->where(key), advice);
}

}  // namespace proto
