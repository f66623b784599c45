#!/usr/bin/env bash
# Plants one violation of each include rule in an empty tree and sees include_rules.sh catch it.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

check() { bash "$here/include_rules.sh" "$tree" >"$tree/output" 2>&1; }

plant() {  # FILE INCLUDE-LINE EXPECTED-TEXT
  mkdir -p "$tree/$(dirname "$1")"
  printf '#pragma once\n%s\n' "$2" >"$tree/$1"
  if check; then
    echo "not caught: $2 in $1"
    exit 1
  fi
  if ! grep -qF "$1:2: $3" "$tree/output"; then
    echo "caught $2 in $1 without saying where or why:"
    cat "$tree/output"
    exit 1
  fi
  rm "$tree/$1"
}

allow() {  # FILE INCLUDE-LINE
  mkdir -p "$tree/$(dirname "$1")"
  printf '%s\n' "$2" >"$tree/$1"
  if ! check; then
    echo "refused without need: $2 in $1"
    cat "$tree/output"
    exit 1
  fi
}

plant proto/case/a.hpp '#include "qdem_solver/model/model.hpp"' 'proto includes nothing'
plant qdem_solver/bed/a.cpp '#include "fem_solver/model/rail.hpp"' 'qdem_solver sees only'
plant fem_solver/time/a.hpp '#include "coupler/record/record.hpp"' 'fem_solver sees only'
plant coupler/scheme/a.cpp '  #  include "qdem_solver/state/state.hpp"' 'coupler sees only'
plant qdem_solver/bed/a.hpp '#include "tests/support/tolerance.hpp"' 'qdem_solver sees only'
plant tests/unit/a.cpp '#include "coupler/app/check_case.hpp"' 'nobody includes an app'
plant coupler/record/a.cpp '#include "coupler/app/check_case.hpp"' 'nobody includes an app'
plant coupler/record/a.cpp '#include "../app/check_case.hpp"' 'includes are written from the root'
plant coupler/record/a.cpp '#include <zmq.hpp>' 'the wire'
plant coupler/record/a.cpp '#include "coupling_generated.h"' 'the wire'
plant fem_solver/model/a.cpp '#include <toml++/toml.h>' 'toml++'
plant coupler/record/a.cpp '#include <hdf5.h>' 'HDF5'
plant qdem_solver/engine/a.cpp '#include <deal.II/base/point.h>' 'deal.II'
plant qdem_solver/model/a.cpp '#include <gmsh.h>' 'the mesher'
plant coupler/app/a.cpp '#include <uv.h>' 'libuv'
plant fem_solver/time/a.cpp '#include <suitesparse/cholmod.h>' 'CHOLMOD'
plant coupler/record/a.cpp '#include <CLI/CLI.hpp>' 'CLI11'
plant qdem_solver/model/a.cuh '#include <cuda_runtime.h>' 'the device'
plant qdem_solver/contact/a.cpp '#include <thrust/sort.h>' 'the device'

allow coupler/app/main.cpp '#include "coupler/app/check_case.hpp"'
allow qdem_solver/output/a.cpp '#include <hdf5.h>'
allow qdem_solver/engine/device/a.cu '#include <thrust/sort.h>'
allow tests/unit/a.cpp '#include "qdem_solver/model/model.hpp"'
echo "every planted violation is caught"
