#include "coupler/report/case_graph.hpp"

#include <fmt/format.h>

namespace coupler {
namespace {

/// As a string of the language: quotes and backslashes of the user's names stay what they are.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n')
      result += "\\n";
    else
      result += c;
  }
  return result + "\"";
}

std::string pad_text(const proto::RailSeat& seat) {
  return fmt::format("rail seat '{}'\n{} x {} cells\n{:.4g} MN/m, {:.4g} kNs/m{}{}", seat.name, seat.cells[0],
                     seat.cells[1], seat.stiffness[2] / 1e6, seat.damping[2] / 1e3,
                     seat.clip_preload > 0.0 ? fmt::format("\nclip {:.4g} kN", seat.clip_preload / 1e3) : "",
                     seat.tension_cutoff ? "\nno tension" : "");
}

std::string coupler_text(const std::string& name, const proto::Coupling& coupling) {
  return fmt::format("coupler: {}\nscheme {}\n{} windows of {:g} s", name, proto::name_of(coupling.scheme),
                     coupling.n_windows, coupling.window_s);
}

std::string file_nodes(const char* owner, const std::string& names) {
  return fmt::format("  {0}_files [shape=note, style=solid, label={1}];\n  {0} -> {0}_files [style=dotted];\n", owner,
                     quoted(names));
}

}  // namespace

std::string case_graph(const std::string& name, const proto::Coupling& coupling,
                       const std::vector<proto::RailSeat>& seats) {
  const bool recorded = proto::plays_recorded_rail(coupling);
  const std::string rail = recorded ? coupling.one_way.history : coupling.fem.command.front();
  std::string text =
      "digraph case {\n  rankdir=LR;\n  fontname=\"sans-serif\";\n"
      "  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n  edge [fontname=\"sans-serif\"];\n";
  text += fmt::format("  coupler [label={}];\n", quoted(coupler_text(name, coupling)));
  text += fmt::format("  qdem [label={}];\n", quoted("qdem: stones, sleeper\n" + coupling.qdem.command.front() +
                                                     "\nexplicit, sub-cycles in each window"));
  text += fmt::format("  fem [label={}];\n", quoted("fem: rail, wheel\n" + rail +
                                                    (recorded ? "\nrecorded" : "\nimplicit, one step a window")));
  text += fmt::format("  fem -> coupler [label={}];\n", quoted("rail motion,\npad force"));
  text += fmt::format("  coupler -> qdem [label={}];\n", quoted("path of the rail"));
  text += fmt::format("  qdem -> coupler [label={}];\n", quoted("impulse,\nsleeper motion"));
  if (!recorded) text += fmt::format("  coupler -> fem [label={}];\n", quoted("force on the rail"));
  for (std::size_t i = 0; i < seats.size(); ++i) {
    text += fmt::format("  seat{} [shape=ellipse, label={}];\n", i, quoted(pad_text(seats[i])));
    text += fmt::format("  fem -> seat{0} -> qdem [dir=none, style=dashed];\n", i);
  }
  text += file_nodes("coupler", "coupling.h5\nsummary.json");
  text += file_nodes("qdem", "qdem.h5");
  if (!recorded) text += file_nodes("fem", "fem.h5");
  return text + "}\n";
}

}  // namespace coupler
