#!/usr/bin/env bash
# A text that names everything passes schema_documented.sh; without one name it does not.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
schema=$1
text=$(mktemp)
trap 'rm -f "$text"' EXIT

tr -c 'A-Za-z_' '\n' <"$schema" >"$text"
bash "$here/schema_documented.sh" "$schema" "$text"
for name in Rollback sub_cycles prescribed_force; do
  tr -c 'A-Za-z_' '\n' <"$schema" | grep -vx "$name" >"$text"
  if bash "$here/schema_documented.sh" "$schema" "$text" >/dev/null; then
    echo "not missed: $name"
    exit 1
  fi
done
