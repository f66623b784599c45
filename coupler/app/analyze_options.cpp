#include "coupler/app/analyze_options.hpp"

#include <map>

namespace coupler {
namespace {

/// A band as two numbers, "LOW HIGH".
void add_band(CLI::App& command, const std::string& name, study::Band& band, const std::string& what) {
  const auto set = [&band](const std::vector<double>& values) { band = {values[0], values[1]}; };
  command.add_option_function<std::vector<double>>(name, set, what + " frequencies of T(f,z) [Hz]")
      ->expected(2)
      ->type_name("LOW HIGH")
      ->check(CLI::Range(0.0, 1e6));
}

}  // namespace

CLI::App* add_analyze_command(CLI::App& app, AnalyzeOptions& options) {
  auto& study = options.study;
  auto* command = app.add_subcommand("analyze", "spectra, T(f,z), modes, fields, pressures and contacts of a run");
  command->add_option("DIR", options.folder, "output folder of a run")->required();
  command->add_option("--out", options.out, "where analysis.h5 and the CSV files go (default: DIR/analysis)");
  command->add_option("--bins", study.n_bins, "depth bins under the sleeper")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--reach", study.reach, "how far beside the sleeper a stone may lie to count as under it [m]")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--axis", study.axis, "motion of T(f,z)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, int>{{"x", 0}, {"y", 1}, {"z", 2}}))
      ->type_name("x|y|z");
  command
      ->add_option("--segment", study.segment,
                   "length of the segments of Welch's method [s] (default: half the record)")
      ->check(CLI::PositiveNumber);
  command->add_option("--overlap", study.overlap, "share of a segment that the next one has in common")
      ->check(CLI::Range(0.0, 0.95))
      ->capture_default_str();
  command->add_option("--window", study.window, "of the segments (default: hann)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, analysis::Window>{
          {"hann", analysis::Window::hann}, {"boxcar", analysis::Window::boxcar}}))
      ->type_name("hann|boxcar");
  add_band(*command, "--low-band", study.low, "low");
  add_band(*command, "--high-band", study.high, "high");
  command->add_option("--highest-mode", study.highest_mode, "modes above are not looked for [Hz]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--decay-from", study.decay_from,
                   "begin of the free decay [s] (default: largest speed after the peak)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--stone", study.chosen, "place of a stone that gets its own histories [m]; may be repeated")
      ->type_name("X Y Z");
  return command;
}

}  // namespace coupler
