// `coupler slurm`: a batch file that runs a case as a heterogeneous job of Slurm.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "coupler/app/case_input.hpp"
#include "coupler/app/kit.hpp"
#include "coupler/launch/program_path.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

struct SlurmOptions {
  std::string case_path, out;
  int hours = 24, qdem_cores = 16, qdem_gpus = 0, fem_cores = 2;
  int margin_s = 300;  ///< before the job's end, to save in
};

/// For a shell, whatever is in it.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string quoted(const std::vector<std::string>& command) {
  std::string result;
  for (const auto& word : command) result += (result.empty() ? "" : " ") + quoted(word);
  return result;
}

int cores_of(const SlurmOptions& options, const std::string& name) {
  return name == "qdem" ? options.qdem_cores : options.fem_cores;
}

/// Component 0 is the coupler, which the batch file itself runs; each participant has one of its own.
std::string directives(const SlurmOptions& options, const CaseInput& input,
                       const std::vector<proto::ParticipantSpec>& participants) {
  auto text = fmt::format(
      "#SBATCH --job-name={}\n#SBATCH --time={}:00:00\n#SBATCH --output=%x-%j.log\n"
      "#SBATCH --ntasks=1 --cpus-per-task=1\n",
      input.file.name(), options.hours);
  for (const auto& spec : participants) {
    text += fmt::format("#SBATCH hetjob\n#SBATCH --ntasks=1 --cpus-per-task={}", cores_of(options, spec.name));
    if (spec.name == "qdem" && options.qdem_gpus > 0) text += fmt::format(" --gpus-per-task={}", options.qdem_gpus);
    text += "\n";
  }
  return text;
}

std::string start_of(const proto::ParticipantSpec& spec, std::size_t component, int cores) {
  return fmt::format(
      "OMP_NUM_THREADS={2} srun --het-group={1} --kill-on-bad-exit=1 {3} --case \"$case\" --endpoint "
      "\"$QDEM_FEM_ENDPOINT\" \\\n"
      "  --server-key \"$keys/coupler.key\" --key \"$keys/{0}.key_secret\" --out \"$out\" --name {0} "
      ">>\"$out/{0}.log\" 2>&1 &\n",
      spec.name, component, cores, quoted(spec.command));
}

std::string job_file(const SlurmOptions& options) {
  const auto input = read_case(options.case_path);
  const auto participants = find_participants(input);
  std::vector<std::string> names;
  std::string starts;
  for (const auto& spec : participants) {
    names.push_back(spec.name);
    starts += start_of(spec, names.size(), cores_of(options, spec.name));
  }
  const std::string out = fs::absolute(options.out.empty() ? "runs/" + input.file.name() : options.out).string();
  return fmt::format(
      R"JOB(#!/bin/bash
# Heterogeneous job: the coupler, {names}. Submit it with sbatch; submitted again it goes on from the newest checkpoint.
# The output folder lies on a disk that all nodes share.
{directives}set -euo pipefail
case={case_path}
out={out}
coupler={coupler}

mkdir -p "$(dirname "$out")"
private=$(mktemp -d "$out.XXXXXX")
trap 'rm -rf "$private"' EXIT
keys=$private/keys
"$coupler" keys "$keys" >/dev/null
address=$(getent ahostsv4 "${{SLURMD_NODENAME:-$(hostname)}}" | awk 'NR == 1 {{ print $1 }}')

order=("$case" --out "$out")
for slot in A B; do
  [[ -e $out/checkpoint/$slot/manifest.json ]] && order=("$case" --resume "$out")
done
rm -f "$out/session"
"$coupler" run "${{order[@]}}" --await {names} --listen "tcp://$address" --keys "$keys" --wall-limit {wall_limit} &
run=$!
trap 'kill -TERM $run' TERM INT
until [[ -s $out/session ]]; do
  kill -0 $run 2>/dev/null || {{ wait $run; exit; }}
  sleep 1
done
. "$out/session"
export QDEM_FEM_SESSION_TOKEN
{starts}
code=0
wait $run || code=$?
while kill -0 $run 2>/dev/null; do  # a signal ended the waiting, not yet the run
  code=0
  wait $run || code=$?
done
((code == 124)) && echo "the time is up; sbatch this file again to go on"
exit $code
)JOB",
      fmt::arg("names", fmt::join(names, ",")), fmt::arg("directives", directives(options, input, participants)),
      fmt::arg("case_path", quoted(input.file.path())), fmt::arg("out", quoted(out)),
      fmt::arg("coupler", quoted(own_path())), fmt::arg("wall_limit", options.hours * 3600 - options.margin_s),
      fmt::arg("starts", starts));
}

}  // namespace

void add_slurm_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("slurm", "print a batch file that runs a case as a heterogeneous job of Slurm");
  const auto options = std::make_shared<SlurmOptions>();
  command->add_option("CASE", options->case_path, "case file (TOML)")->required();
  command->add_option("--out", options->out, "output folder on a shared disk (default: runs/<case>)");
  command->add_option("--hours", options->hours, "wall time of the job")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--margin", options->margin_s, "seconds before its end at which the run saves and stops")
      ->check(CLI::Range(10, 3000))
      ->capture_default_str();
  command->add_option("--qdem-cores", options->qdem_cores, "cores of qdem")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--qdem-gpus", options->qdem_gpus, "GPUs of qdem (engine = \"cuda\")")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_option("--fem-cores", options->fem_cores, "cores of fem")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->callback([options, &chosen] {
    chosen = [options] {
      fmt::print("{}", job_file(*options));
      return 0;
    };
  });
}

}  // namespace coupler
