#!/usr/bin/env bash
# cuda_build.sh ROOT LIBRARIES OUT [INCLUDE...]: compiles the CUDA engine for one architecture and links it with the
# rest of the engine, wherever nvcc is. Records registers, spills and shared memory of every kernel in OUT/kernels.txt.
# The element kernels must not spill. Exit code 77: NOT RUN, no nvcc.
#   LIBRARIES: the static libraries to link, separated by ";", qdem_engine first.
set -euo pipefail
export LC_ALL=C
root=$1 libraries=$2 out=$3
shift 3

nvcc=$(command -v nvcc || true)
[[ -n $nvcc || ! -x /usr/local/cuda/bin/nvcc ]] || nvcc=/usr/local/cuda/bin/nvcc
if [[ -z $nvcc ]]; then
  echo "NOT RUN: nvcc is not here, so the CUDA engine was not compiled"
  exit 77
fi
mkdir -p "$out"
cd "$out"

# A compilation takes half a minute: it is kept until one of its files changes.
is_current() {
  [[ -s cuda.o && -s cuda.d && -s ptxas.txt ]] || return 1
  local file
  while read -r file; do
    [[ -e $file && ! $file -nt cuda.o ]] || return 1
  done < <(sed -e 's/^[^:]*://' -e 's/\\$//' cuda.d | tr -s ' ' '\n' | sed '/^$/d')
}
if ! is_current; then
  rm -f cuda.o
  "$nvcc" -std=c++17 -O3 -arch=sm_90 --expt-relaxed-constexpr -diag-suppress 20012 -Xptxas -v -MD -MF cuda.d \
    "${@/#/-isystem=}" -I"$root" -c "$root/qdem_solver/engine/device/cuda.cu" -o cuda.o >ptxas.txt 2>&1 ||
    { cat ptxas.txt; exit 1; }
fi

# One line a kernel of ours: name, registers, bytes spilled, bytes of shared memory.
c++filt <ptxas.txt | awk '
  /Compiling entry function/ {
    name = ""
    gsub(/qdem::|device::|\(anonymous namespace\)::/, "")
    if (match($0, /run_kernel<[^(]*/)) name = substr($0, RSTART + 11, RLENGTH - 12)
  }
  /spill stores/ && name != "" { for (i = 1; i < NF; ++i) if ($(i + 2) == "spill") spilled += $i }
  /Used [0-9]+ registers/ && name != "" {
    shared = 0
    for (i = 1; i < NF; ++i) { if ($i == "Used") registers = $(i + 1); if ($(i + 1) == "bytes" && $(i + 2) ~ /^smem/) shared = $i }
    printf "%-32s registers %4d  spilled %4d  shared %5d\n", name, registers, spilled, shared
    spilled = 0; name = ""
  }' | sort >kernels.txt
cat kernels.txt
for law in QuadrupleLaw BondLaw; do
  line=$(grep -F "ElementForces<$law>" kernels.txt) || { echo "no report on the element kernel of $law"; exit 1; }
  [[ $line =~ spilled\ +0\  ]] || { echo "the element kernel of $law spills registers"; exit 1; }
done

cat >main.cpp <<'CODE'
#include <cstdio>

#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"

int main() {
  const std::string reason = qdem::why_no_engine(qdem::EngineKind::cuda);
  qdem::Model model;
  qdem::EngineOptions options;
  options.kind = qdem::EngineKind::cuda;
  try {
    qdem::Engine engine(model, options);
    std::printf("there is a device\n");
    return reason.empty() ? 0 : 1;
  } catch (const proto::Error& error) {
    std::printf("%s\n", error.what());
    return error.code() == proto::ExitCode::unavailable && !reason.empty() ? 0 : 1;
  }
}
CODE
IFS=';' read -r -a archives <<<"$libraries"
# nvcc links, because it alone knows where its runtime lies. cuda.o stands before the archives, so that it serves what
# no_cuda.cpp would.
"$nvcc" -std=c++17 -arch=sm_90 "${@/#/-isystem=}" -I"$root" main.cpp cuda.o "${archives[@]}" -lgomp -lxxhash -o linked
./linked
