#!/usr/bin/env bash
# include_rules.sh ROOT: who may include whom, and behind which door each third party lives.
# Prints every violation as "file:line: rule"; exit code 1 if there is one.
set -euo pipefail
export LC_ALL=C
cd "$1"

n_violations=0
report() {  # RULE, then "file:line:text" lines on stdin
  local line
  while IFS= read -r line; do
    printf '%s: %s\n' "$(cut -d: -f1,2 <<<"$line")" "$1"
    n_violations=$((n_violations + 1))
  done
}

# "file:line:target" of every include directive of the tree.
folders=()
for folder in proto qdem_solver fem_solver coupler tests; do
  [[ -d $folder ]] && folders+=("$folder")
done
all=$({ grep -rnE --include='*.hpp' --include='*.cpp' --include='*.h' --include='*.cu' --include='*.cuh' --include='*.in' \
  '^[[:space:]]*#[[:space:]]*include' "${folders[@]}" || true; } |
  sed -E 's/^([^:]*:[0-9]+:)[[:space:]]*#[[:space:]]*include[[:space:]]*["<]([^">]*)[">].*/\1\2/')

# Our own folders: every arrow points to proto.
arrows() {  # FOLDER RULE ALLOWED-TARGETS
  report "$2" < <(grep -E "^$1/[^:]*:[0-9]+:(proto|qdem_solver|fem_solver|coupler|tests|cases)/" <<<"$all" |
    grep -vE ":[0-9]+:($3)/" || true)
}
arrows proto 'proto includes nothing of the house but itself' 'proto'
arrows qdem_solver 'qdem_solver sees only itself and proto' 'qdem_solver|proto'
arrows fem_solver 'fem_solver sees only itself and proto' 'fem_solver|proto'
arrows coupler 'coupler sees only itself and proto' 'coupler|proto'

# An app is included by nobody but itself.
report 'nobody includes an app' < <(grep -E ':[0-9]+:[a-z_]+/app/' <<<"$all" |
  grep -vE '^([a-z_]+/app)/[^:]*:[0-9]+:\1/' || true)

# A relative include would slip through the rules above.
report 'includes are written from the root' < <(grep -E ':[0-9]+:\.\.?/' <<<"$all" || true)

# Third parties: TARGET-PATTERN, the folders of its door, its name. Tests may see what they test.
door() {
  report "$3 is included only in $2" < <(grep -E "^[^:]*:[0-9]+:($1)" <<<"$all" | grep -vE "^($2|tests)/" || true)
}
door 'zmq|flatbuffers/|coupling_generated' 'proto/wire|proto/session' 'the wire (ZeroMQ, FlatBuffers)'
door 'toml\+\+|toml\.hpp' 'proto/case' 'toml++'
door 'hdf5|H5' 'proto/result|qdem_solver/output' 'HDF5'
door 'deal\.II/' 'fem_solver' 'deal.II'
door 'gmsh|libqhull|qhull' 'qdem_solver/bed' 'the mesher (Gmsh, Qhull)'
door 'CGAL/' 'qdem_solver/bed' 'CGAL'
door 'uv\.h' 'coupler/launch' 'libuv'
door 'cholmod|suitesparse/' 'fem_solver/linear' 'CHOLMOD'
door 'thrust/|cub/|cuda' 'qdem_solver/engine/device' 'the device (CUDA, Thrust)'
door 'CLI/' '[a-z_]+/app|proto/example' 'CLI11'

if ((n_violations > 0)); then
  echo "$n_violations violations of the include rules"
  exit 1
fi
echo "include rules kept"
