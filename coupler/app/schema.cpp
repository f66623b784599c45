// `coupler schema`: the JSON Schema of a case file, put together from what each program reads of it.
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "coupler/app/kit.hpp"
#include "coupler/app/kit_candidate.hpp"
#include "coupler/launch/children.hpp"
#include "coupler/launch/program_path.hpp"
#include "proto/case/case_schema.hpp"
#include "proto/case/coupling.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/error.hpp"

namespace coupler {
namespace {

using Json = nlohmann::ordered_json;

constexpr double limit_s = 60.0;

/// What `PROGRAM schema` prints.
Json schema_of(const std::string& name, const std::string& folder) {
  const auto program = find_program(name, "the schema's sections of " + name);
  const auto path = folder + "/" + name + ".json";
  Children children(own_path());
  children.start({name, {program, "schema"}, {}, path});
  for (double waited = 0.0; waited < limit_s && !children.exit_of(name); waited += 0.1) children.wait(0.1);
  const auto exit = children.exit_of(name);
  std::ostringstream stream;
  stream << std::ifstream(path).rdbuf();
  const auto text = stream.str();
  auto schema = Json::parse(text, nullptr, false);
  if (!exit || exit->code != 0 || exit->signal != 0 || schema.is_discarded())
    throw proto::Error(proto::ExitCode::unavailable, name + " gave no schema", program, text.substr(0, 400));
  return schema;
}

/// Adds to `into` what only `from` says; a key is required where one of the two requires it.
void merge(Json& into, const Json& from) {
  for (const auto& [key, value] : from.items()) {
    if (!into.contains(key)) {
      into[key] = value;
    } else if (value.is_object()) {
      merge(into[key], value);
    } else if (key == "required") {
      auto names = into[key].get<std::set<std::string>>();
      for (const auto& name : value) names.insert(name);
      into[key] = names;
    }
  }
}

int print_schema() {
  const Workplace workplace("");
  auto schema = Json::parse(proto::case_schema({[](const proto::CaseFile& file) { proto::read_coupling(file); },
                                                [](const proto::CaseFile& file) { proto::read_rail_seats(file); }}));
  for (const char* program : {"qdem_solver", "fem_solver", "oscillator_participant"})
    merge(schema, schema_of(program, workplace.path()));
  schema["title"] = "Case file of the coupled simulation of ballasted track";
  fmt::print("{}\n", schema.dump(2));
  return 0;
}

}  // namespace

void add_schema_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("schema", "print the JSON Schema of a case file, for editors and checkers");
  command->callback([&chosen] { chosen = print_schema; });
}

}  // namespace coupler
