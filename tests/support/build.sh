# shellcheck shell=bash
# What cases/run and tests/run share: the Debian packages this project needs, and how it is built.
# Sourced by bash; sets house_root. Messages go to stderr.

house_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)

# Debian 12. The one list of packages; README.md names what each is for.
house_packages=(
  g++ cmake ninja-build pkg-config git
  libdeal.ii-dev libeigen3-dev libsuitesparse-dev libgmsh-dev libcgal-dev
  libthrust-dev libzmq3-dev cppzmq-dev libflatbuffers-dev flatbuffers-compiler
  libhdf5-dev libhdf5-openmpi-dev
  libtomlplusplus-dev libcli11-dev libspdlog-dev libfmt-dev libxxhash-dev libuv1-dev nlohmann-json3-dev
  libgtest-dev gnuplot-nox graphviz python3-zmq python3-flatbuffers python3-xxhash
  python3-h5py python3-matplotlib
  iproute2 python3-jsonschema
)
# npm makes the page of the reports; where it comes from elsewhere, Debian's is not asked for.
command -v npm >/dev/null || house_packages+=(nodejs npm)

house_say() { printf '%s\n' "$*" >&2; }

# Prints the packages of the list that are not installed. Asks dpkg only; no network.
house_missing_packages() {
  local installed package
  installed=$(dpkg-query -W -f='${db:Status-Status}:${Package}\n' "${house_packages[@]}" 2>/dev/null || true)
  for package in "${house_packages[@]}"; do
    [[ $'\n'$installed$'\n' == *$'\n'"installed:$package"$'\n'* ]] || printf '%s\n' "$package"
  done
}

# Installs what is missing if root; else prints the one command to run and stops with exit code 69.
house_install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    house_say "This is not Debian: install the counterparts of these packages yourself, then build with cmake --preset release:"
    house_say "  ${house_packages[*]}"
    exit 69
  fi
  local missing
  mapfile -t missing < <(house_missing_packages)
  ((${#missing[@]} == 0)) && return
  if ((EUID != 0)); then
    house_say "Packages are missing. Run this once, then start again:"
    house_say "  sudo apt-get update && sudo apt-get install --no-install-recommends -y ${missing[*]}"
    exit 69
  fi
  house_say "Installing ${#missing[@]} missing packages: ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  if ! apt-get update -q </dev/null >&2 ||
     ! apt-get install --no-install-recommends -y -q "${missing[@]}" </dev/null >&2; then
    house_say "apt-get could not install them (see above)."
    exit 69
  fi
}

# Number of compilers at once: a unit that includes deal.II takes about 1.5 GiB.
house_jobs() {
  local cores memory_kib by_memory
  cores=$(nproc)
  memory_kib=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
  by_memory=$((memory_kib / (1536 * 1024)))
  ((by_memory < 1)) && by_memory=1
  echo $((cores < by_memory ? cores : by_memory))
}

# house_build PRESET [TARGET...]: configures once (the build itself notices changed CMake files) and builds.
house_build() {
  local preset=$1 folder="$house_root/build/$1" fresh=() targets=()
  shift
  (($# > 0)) && targets=(--target "$@")
  # A tree that was copied or moved has a build folder that belongs to another place.
  if [[ -f $folder/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$house_root" "$folder/CMakeCache.txt"; then
    fresh=(--fresh)
  fi
  if [[ ! -f $folder/build.ninja ]] || ((${#fresh[@]} > 0)); then
    (cd "$house_root" && cmake --preset "$preset" "${fresh[@]}" >&2) || return
  fi
  cmake --build "$folder" -j "$(house_jobs)" "${targets[@]}" >&2
}
