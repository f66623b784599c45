#!/usr/bin/env bash
# Plants what text_hygiene.sh must find, one at a time.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

plant() {  # CONTENT EXPECTED-TEXT
  printf '%b' "$1" >"$tree/a.cpp"
  if bash "$here/text_hygiene.sh" "$tree" >"$tree/output" 2>&1 || ! grep -qF "./a.cpp:" "$tree/output" ||
     ! grep -qF "$2" "$tree/output"; then
    echo "not caught: $2"
    cat "$tree/output"
    exit 1
  fi
}

plant 'int a; \n' 'white space'
plant '\tint a;\n' 'a tab'
plant 'int a;\r\n' 'a carriage return'
plant 'int a;' 'newline'
plant '// TODO: b\n' 'a note to self'
plant 'auto path = "/root/x";\n' 'a path of one machine'
plant '"resolved": "x"\n' 'the address of a download'
plant "$(printf '\\n%.0s' {1..451})" 'longer than'
printf 'int a;\n' >"$tree/a.cpp"
bash "$here/text_hygiene.sh" "$tree"
