#!/usr/bin/env bash
# text_hygiene.sh ROOT: what no file of the tree may hold. Prints violations; exit code 1 if there is one.
set -euo pipefail
export LC_ALL=C
cd "$1"
readonly largest_file=450

mapfile -d '' files < <(find . \( -path ./build -o -path ./runs -o -path ./.git -o -path ./.cache \) -prune -o \
  -type f \( -name '*.hpp' -o -name '*.cu' -o -name '*.cuh' -o -name '*.cpp' -o -name '*.cmake' -o -name '*.txt' -o -name '*.toml' \
  -o -name '*.md' -o -name '*.fbs' -o -name '*.sh' -o -name '*.json' -o -name '*.js' -o -name '*.mjs' -o -name '*.css' \
  -o -name '*.html' -o -name run \) -print0 | sort -z)

n_violations=0
complain() {
  printf '%s\n' "$1"
  n_violations=$((n_violations + 1))
}
forbid() {  # EXTENDED-REGEX REASON [FILE-REGEX that is exempt]
  local hit
  while IFS= read -r hit; do
    [[ -n ${3-} && $hit =~ ^./($3) ]] || complain "$(cut -d: -f1,2 <<<"$hit"): $2"
  done < <(grep -nHE "$1" "${files[@]}" || true)
}

for file in "${files[@]}"; do
  lines=$(wc -l <"$file")
  [[ $file == */package-lock.json ]] || ((lines <= largest_file)) || complain "$file:$lines: longer than $largest_file lines"
  [[ ! -s $file || -z $(tail -c 1 "$file") ]] || complain "$file:$lines: does not end with a newline"
done
forbid '[[:space:]]+$' 'white space at the end of the line'
forbid $'\t' 'a tab'
forbid $'\r' 'a carriage return'
self='tests/contract/'
forbid '\b(TODO|FIXME|XXX|HACK)\b' 'a note to self: do it or say in a README that it is not there' "$self"
forbid '(^|[^A-Za-z0-9_.-])(/work/|/root/|/home/[a-z])' 'a path of one machine' "$self"
forbid '^ *"resolved":' 'a lock file with the address of a download' "$self"
forbid '^(<<<<<<<|>>>>>>>)( |$)' 'a merge that was not finished' "$self"

if ((n_violations > 0)); then
  echo "$n_violations violations"
  exit 1
fi
echo "${#files[@]} files are clean"
