#!/usr/bin/env bash
# build_page.sh SOURCE WORK PAGE: installs the locked packages into WORK and bundles SOURCE into PAGE. Without a page at
# the end it has said why; the exit code is 0 all the same, because everything else works without one.
set -euo pipefail
source_folder=$1 work=$2 page=$3

give_up() {
  rm -f "$page"
  echo "no report page: $1; coupler report will say so" >&2
  exit 0
}

mkdir -p "$work" "$(dirname "$page")"
cd "$work"
if ! cmp -s "$source_folder/package-lock.json" installed.json || [[ ! -d node_modules ]]; then
  rm -f installed.json  # what npm leaves half-way must not count
  cp "$source_folder/package.json" "$source_folder/package-lock.json" .
  npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 --fetch-timeout=60000 >npm.log 2>&1 ||
    give_up "npm could not install the packages of package-lock.json ($work/npm.log)"
  cp package-lock.json installed.json
fi
node "$source_folder/bundle.mjs" "$source_folder/src" "$work/node_modules" "$page" || give_up "the bundler failed"
