// `coupler graph`: a picture of a case.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "coupler/app/case_input.hpp"
#include "coupler/app/drawing.hpp"
#include "coupler/app/kit.hpp"
#include "coupler/report/case_graph.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

int graph_case(const std::string& case_path, const std::string& out) {
  const auto input = read_case(case_path);
  const auto picture = out.empty() ? input.file.name() + ".svg" : out;
  const auto script = std::filesystem::path(picture).replace_extension(".dot").string();
  proto::write_text_file(script, case_graph(input.file.name(), input.coupling, input.seats));
  draw("dot", {"-Tsvg", script, "-o", picture}, script, picture);
  return 0;
}

}  // namespace

void add_graph_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("graph", "draw who takes part in a case, and what goes between them");
  const auto case_path = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  command->add_option("CASE", *case_path, "case file (TOML)")->required();
  command->add_option("--out", *out, "SVG file (default: <case>.svg here); its source beside it as .dot");
  command->callback([case_path, out, &chosen] { chosen = [case_path, out] { return graph_case(*case_path, *out); }; });
}

}  // namespace coupler
