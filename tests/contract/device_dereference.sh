#!/usr/bin/env bash
# device_dereference.sh ROOT: host code that looks into device memory does not compile; the same code without the look
# does.
set -euo pipefail
root=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

compiles() {  # BODY of a host function with a device pointer p
  cat >"$folder/host.cpp" <<CODE
#include "qdem_solver/engine/device/pointer.hpp"
double look(qdem::device::Pointer<double> p) { $1 }
CODE
  g++ -std=c++17 -fsyntax-only -I"$root" "$folder/host.cpp" 2>"$folder/errors"
}

compiles 'auto q = p + 3; (void)q; return 0;' || { cat "$folder/errors"; echo "a pointer cannot even be moved"; exit 1; }
while IFS= read -r body; do
  if compiles "$body"; then
    echo "host code compiles: $body"
    exit 1
  fi
done <<'BODIES'
return *p;
return p[0];
double* q = p; return *q;
return qdem::device::Access()(p)[0];
return *p.address_;
BODIES
echo "device memory stays closed to host code"
