#!/usr/bin/env bash
# `coupler slurm`: the file is a batch file of a heterogeneous job, and it runs a case, here with a program in the place of
# srun that starts what it is given on this machine.
# usage: slurm_job.sh BIN_FOLDER CASES
set -euo pipefail
bin=$(cd "$1" && pwd) cases=$(cd "$2" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
check() {  # check WHAT COMMAND...
  if "${@:2}"; then return; fi
  echo "FAILED: $1"
  failures=$((failures + 1))
}
holds() { grep -qF -- "$1" "$2"; }

job=$work/passage.sh
"$bin/coupler" slurm "$cases/wheel_passage/case.toml" --hours 12 --qdem-cores 32 --qdem-gpus 1 --fem-cores 4 \
  --out "$work/it's a run" >"$job"
check "it is a shell script" bash -n "$job"
check "three components" test "$(grep -c '^#SBATCH hetjob$' "$job")" = 2
check "directives stand before the first command" test "$(sed '/^set /,$d' "$job" | grep -c '^#SBATCH')" = 8
for line in "#SBATCH --job-name=wheel_passage" "#SBATCH --time=12:00:00" "#SBATCH --ntasks=1 --cpus-per-task=1" \
  "#SBATCH --ntasks=1 --cpus-per-task=32 --gpus-per-task=1" "#SBATCH --ntasks=1 --cpus-per-task=4" \
  "--wall-limit 42900" "srun --het-group=1" "srun --het-group=2" "--await qdem,fem"; do
  check "the line $line" holds "$line" "$job"
done

# One that runs: twice, to its end and on from its end.
mkdir "$work/slurm"
cat >"$work/slurm/srun" <<'SRUN'
#!/usr/bin/env bash
while [[ $1 == -* ]]; do shift; done
exec "$@"
SRUN
chmod +x "$work/slurm/srun"
"$bin/coupler" slurm "$cases/split_oscillator/case.toml" --out "$work/it's a run" --fem-cores 1 >"$work/job.sh"
for attempt in first second; do
  code=0
  SLURMD_NODENAME=127.0.0.1 PATH="$work/slurm:$PATH" timeout 60 bash "$work/job.sh" >"$work/$attempt.log" 2>&1 || code=$?
  check "the $attempt run ends well" test $code = 0
done
check "the second went on" holds "resumed after window 159" "$work/it's a run/run.log"
check "nothing of the keys is left" test "$(find "$work" -name '*.key*' | wc -l)" = 0

((failures == 0)) && echo "slurm: all right" && exit 0
cat "$work"/*.log "$work/it's a run"/*.log
exit 1
