#include "proto/case/probe.hpp"

#include <algorithm>
#include <sstream>

#include "proto/case/section_data.hpp"

namespace proto {
namespace {

struct Step {
  std::string key;
  int index = -1;  ///< of the element of an array of tables; -1: a table
};

std::vector<Step> steps_of(const std::string& place) {
  std::vector<Step> steps;
  std::istringstream stream(place);
  for (std::string part; std::getline(stream, part, '.');) {
    const auto bracket = part.find('[');
    if (bracket == std::string::npos)
      steps.push_back({part});
    else
      steps.push_back({part.substr(0, bracket), std::stoi(part.substr(bracket + 1))});
  }
  return steps;
}

const toml::table* find(const toml::table& root, const std::string& place) {
  const toml::table* table = &root;
  for (const auto& step : steps_of(place)) {
    const auto* node = table->get(step.key);
    if (node && step.index >= 0) node = node->as_array()->get(static_cast<std::size_t>(step.index));
    table = node ? node->as_table() : nullptr;
    if (!table) return nullptr;
  }
  return table;
}

/// The table at `place`; made where it is missing. Elements of arrays are there.
toml::table& reach(toml::table& root, const std::string& place) {
  toml::table* table = &root;
  for (const auto& step : steps_of(place)) {
    if (!table->get(step.key)) table->insert(step.key, toml::table{});
    auto* node = table->get(step.key);
    if (step.index >= 0) node = node->as_array()->get(static_cast<std::size_t>(step.index));
    table = node->as_table();
  }
  return *table;
}

void put(toml::array& list, const Schema& value) {
  if (value.is_object()) list.push_back(toml::table{});
  if (value.is_string()) list.push_back(value.get<std::string>());
  if (value.is_number_integer()) list.push_back(value.get<std::int64_t>());
  if (value.is_number_float()) list.push_back(value.get<double>());
}

void put(toml::table& table, const std::string& key, const Schema& value) {
  if (value.is_object()) table.insert_or_assign(key, toml::table{});
  if (value.is_string()) table.insert_or_assign(key, value.get<std::string>());
  if (value.is_boolean()) table.insert_or_assign(key, value.get<bool>());
  if (value.is_number_integer()) table.insert_or_assign(key, value.get<std::int64_t>());
  if (value.is_number_float()) table.insert_or_assign(key, value.get<double>());
  if (!value.is_array()) return;
  toml::array list;
  for (const auto& element : value) put(list, element);
  table.insert_or_assign(key, std::move(list));
}

bool in_range(const Schema& schema, double value) {
  return !(schema.contains("minimum") && value < schema["minimum"].get<double>()) &&
         !(schema.contains("exclusiveMinimum") && value <= schema["exclusiveMinimum"].get<double>()) &&
         !(schema.contains("maximum") && value > schema["maximum"].get<double>());
}

bool allows(const Schema& schema, const toml::node& node);
bool allows_list(const Schema& schema, const toml::array& list) {
  if (schema.contains("minItems") && list.size() != schema["minItems"].get<std::size_t>()) return false;
  return std::all_of(list.begin(), list.end(), [&](const auto& element) { return allows(schema["items"], element); });
}

bool allows(const Schema& schema, const toml::node& node) {
  if (!schema.contains("type")) return true;
  const auto type = schema["type"].get<std::string>();
  if (type == "object") return node.is_table();
  if (type == "boolean") return node.is_boolean();
  if (type == "array") return node.is_array() && allows_list(schema, *node.as_array());
  if (type == "integer") return node.is_integer() && in_range(schema, *node.value<double>());
  if (type == "number") return node.is_number() && in_range(schema, *node.value<double>());
  if (!node.is_string()) return false;
  if (!schema.contains("enum")) return true;
  const auto& choices = schema["enum"];
  return std::count(choices.begin(), choices.end(), *node.value<std::string>()) > 0;
}

double some_number(const Schema& schema, double step) {
  const bool is_bounded = schema.contains("maximum");
  const double lowest = schema.value("minimum", schema.value("exclusiveMinimum", 0.0));
  const double highest = schema.value("maximum", lowest + 2 * step);
  return is_bounded ? std::min(lowest + step, (lowest + highest) / 2) : lowest + step;
}

}  // namespace

bool Probe::has(const KeyNote& key) const {
  const auto* table = find(document_, key.place);
  return table && table->contains(key.key);
}

bool Probe::fits(const KeyNote& key) const {
  return has(key) && allows(key.schema, *find(document_, key.place)->get(key.key));
}

void Probe::set(const KeyNote& key, const Schema& value) {
  put(reach(document_, key.place), key.key, value);
}

Reading Probe::read(const CaseReader& reader) const {
  Reading reading;
  try {
    auto document = std::make_shared<CaseDocument>();
    document->root = document_;
    document->notes = &reading.notes;
    auto root = std::make_shared<Section::Data>();
    root->table = &document->root;
    root->document = std::move(document);
    reader(CaseFile(std::move(root)));
  } catch (const std::exception&) {  // what is wrong with a made-up case is no matter
    reading.failed = true;
  }
  return reading;
}

bool is_open(const Schema& schema) {
  const auto choices = schema.value("enum", Schema::array());
  return std::count(choices.begin(), choices.end(), name_of_ones_own) > 0;
}

Schema some_value(const Schema& schema) {
  if (!schema.contains("type")) return 0.5;
  const auto type = schema["type"].get<std::string>();
  if (type == "object") return Schema::object();
  if (type == "boolean") return true;
  if (type == "string") return schema.contains("enum") ? schema["enum"][0] : Schema(name_of_ones_own);
  // Two, so that a number that must be even is.
  if (type == "integer") return static_cast<std::int64_t>(some_number(schema, 2.0));
  if (type == "number") return some_number(schema, 1.0);
  Schema list = Schema::array();
  for (std::size_t i = 0; i < schema.value("minItems", std::size_t{1}); ++i)
    list.push_back(some_value(schema["items"]));
  return list;
}

}  // namespace proto
