#include "fem_solver/app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "fem_solver/app/alone.hpp"
#include "fem_solver/participant/fem_participant.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

int run(int argc, char** argv, const FemProgram& program) {
  CLI::App app(program.description, program.name);
  app.require_subcommand(1);
  std::string path, endpoint, name = "fem", out = ".";
  proto::KeyFiles keys;
  auto* participant = app.add_subcommand("participant", "take part in a coupled run; started by the coupler");
  participant->add_option("--case", path, "case file")->required();
  participant->add_option("--endpoint", endpoint, "where the coupler listens")->required();
  participant->add_option("--server-key", keys.server, "public key of a coupler on another machine");
  participant->add_option("--key", keys.own, "own secret key");
  participant->add_option("--out", out, "output folder");
  participant->add_option("--name", name, "name in the session");
  auto* check = app.add_subcommand("check", "validate the case's FEM sections and the rail without running");
  check->add_option("--case", path, "case file")->required();
  auto* statics = app.add_subcommand("static", "print deflection and seat forces with the wheel standing at its start");
  statics->add_option("case", path, "case file")->required();
  auto* alone = app.add_subcommand("run", "run the wheel over the rail alone, every seat on the support model");
  alone->add_option("case", path, "case file")->required();
  alone->add_option("--out", out, "output folder; must exist");
  auto* contact = app.add_subcommand("contact", "one contact of wheel and rail: patch, stick and slip, creep forces");
  contact->add_option("case", path, "case file with [contact]")->required();
  contact->add_option("--out", out, "output folder; must exist");
  auto* schema = app.add_subcommand("schema", "print the JSON Schema of the case's FEM sections");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(proto::ExitCode::usage);
  }

  if (contact->parsed()) {
    run_contact(path, program.name, program.blocks, out);
    return 0;
  }
  if (schema->parsed()) {
    std::printf("%s\n", fem_schema().c_str());
    return 0;
  }
  auto input = read_fem_case(path);
  if (check->parsed()) {
    check_case(input, program);
  } else if (statics->parsed()) {
    print_static(input, program);
  } else if (alone->parsed()) {
    run_alone(input, program, out);
  } else {
    const auto options = proto::read_session_options(endpoint, input.file.hash(), keys);
    FemParticipant body(std::move(input), program.name, name, program.build, program.build_wheel);
    proto::serve(body, options);
  }
  return 0;
}

}  // namespace

int fem_program(int argc, char** argv, const FemProgram& program) {
  try {
    return run(argc, argv, program);
  } catch (const proto::Error& error) {
    std::fprintf(stderr, "%s: %s\n", program.name.c_str(), error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: internal error: %s\n", program.name.c_str(), error.what());
    return static_cast<int>(proto::ExitCode::internal);
  }
}

}  // namespace fem
