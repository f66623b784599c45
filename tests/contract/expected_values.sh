#!/usr/bin/env bash
# expected_values.sh ROOT PROGRAMS: a case is judged by its expected values, missed ones are told, and slips in
# expected.toml are refused.
set -euo pipefail
root=$1 programs=$2 n_bad=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$root/cases/split_oscillator" "$scratch/case"

# judged CODE TEXT: study.py on the case ends with CODE and says TEXT.
judged() {
  local code=0
  python3 "$root/cases/study.py" "$scratch/case" --programs "$programs" --by suite >"$scratch/text" 2>&1 || code=$?
  if ((code != $1)) || ! grep -qF "$2" "$scratch/text"; then
    echo "ended with exit code $code, wanted $1 and \"$2\":"
    cat "$scratch/text"
    n_bad=$((n_bad + 1))
  fi
}

# uA of the closed form in the case's README, and that of T/2.
expected() {
  cat >"$scratch/case/expected.toml" <<TOML
[[run]]
by = ["suite"]
changes = { "coupling.duration_s" = $1 }
[[run.expected]]
quantity = "uA"
summary = "oscillator.implicit.x"
$2
source = "closed form"
TOML
}

expected 4.0 $'value = 0.5745\ntolerance = 0.02' && judged 0 'ok     uA'
expected 4.0 $'range = [0.55, 0.60]' && judged 0 'ok     uA'
expected 2.0 $'value = 0.5745\ntolerance = 0.02' && judged 1 'MISSED uA'
expected 4.0 $'value = 0.5745' && judged 65 'give value with tolerance'
expected 4.0 $'value = 0.5745\ntolerance = 0.02\nunit = "m"' && judged 65 "unknown key 'unit'"
sed -i 's/^\[\[run.expected/changess = 1\n&/' "$scratch/case/expected.toml" && judged 65 "unknown key 'changess'"
expected 4.0 $'value = 0.5745\ntolerance = 0.02' && sed -i 's/coupling.duration_s/couplin.duration_s/' "$scratch/case/expected.toml"
judged 65 '[couplin] stands 0 times'
echo "$n_bad problems"
((n_bad == 0))
