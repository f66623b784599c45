#!/usr/bin/env bash
# cases_accepted.sh COUPLER ROOT: every shipped case has a README and is accepted by "coupler check", with or
# without [coupling]; one with a mistyped key is not.
set -euo pipefail
coupler=$1 root=$2
n_cases=0 n_bad=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for folder in "$root"/cases/*/; do
  n_cases=$((n_cases + 1))
  for file in case.toml README.md; do
    [[ -f $folder$file ]] || { echo "$folder$file is missing"; n_bad=$((n_bad + 1)); }
  done
  [[ -f ${folder}case.toml ]] || continue
  "$coupler" check "${folder}case.toml" || { echo "refused: ${folder}case.toml"; n_bad=$((n_bad + 1)); }
done

typo="$scratch/case.toml"
sed 's/^window_s/windw_s/' "$root/cases/split_oscillator/case.toml" >"$typo"
code=0
"$coupler" check "$typo" 2>"$scratch/text" || code=$?
if ((code != 78)) || ! grep -qF "did you mean 'window_s'" "$scratch/text"; then
  echo "a mistyped key ended with exit code $code and:"
  cat "$scratch/text"
  n_bad=$((n_bad + 1))
fi
echo "$n_cases cases, $n_bad problems"
((n_cases >= 2 && n_bad == 0))
