#!/usr/bin/env bash
# A run across two hosts: two network namespaces joined by a veth pair. The participant `fem` is started by hand on the
# far one. Strangers come first, without a key, with a key that nobody knows, for another coupler; then the right one.
# usage: two_hosts.sh BIN_FOLDER CASE_FOLDER
# Exit code 77 where this machine gives no namespaces.
set -euo pipefail
bin=$(cd "$1" && pwd) case_folder=$(cd "$2" && pwd)
near=10.99.0.1

if [[ ${3:-} != inside ]]; then
  # In namespaces of our own no root is needed, and nothing outlives this script.
  unshare --user --map-root-user --net --mount true 2>/dev/null ||
    { echo "NOT RUN: no user and network namespaces here"; exit 77; }
  exec unshare --user --map-root-user --net --mount --pid --fork --kill-child --mount-proc bash "$0" "$1" "$2" inside
fi

set_up_hosts() {
  mount -t tmpfs tmpfs /run && ip netns add far && ip link add near0 type veth peer name far0 netns far &&
    ip address add $near/24 dev near0 && ip link set lo up && ip link set near0 up &&
    ip -n far address add 10.99.0.2/24 dev far0 && ip -n far link set far0 up
}
set_up_hosts 2>/dev/null || { echo "NOT RUN: no pair of network namespaces here"; exit 77; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$case_folder/case.toml" "$work/case.toml"
failures=0
check() {  # check WHAT COMMAND...
  if "${@:2}"; then return; fi
  echo "FAILED: $1"
  failures=$((failures + 1))
}
on_far() { ip netns exec far timeout 20 "$@"; }
fem() {  # fem KEY_OPTION...; its exit code in $code
  code=0
  (. "$work/out/session" && export QDEM_FEM_SESSION_TOKEN &&
    on_far "$bin/oscillator_participant" participant --side implicit --case "$work/case.toml" --out "$work" --name fem \
      --endpoint "$QDEM_FEM_ENDPOINT" "$@") 2>>"$work/fem.log" || code=$?
}
said() { grep -q -- "$1" "$2"; }

"$bin/coupler" keys "$work/keys" >/dev/null
"$bin/coupler" keys "$work/strangers" >/dev/null
check "secret keys are for their owner alone" test "$(stat -c %a "$work"/keys/*.key_secret | sort -u)" = 600

# What is refused before anything is bound.
code=0
"$bin/coupler" run "$work/case.toml" --out "$work/no" --listen tcp://$near --await fem 2>"$work/err" || code=$?
check "no way in from other hosts without keys" test "$code" = 64
check "its reason" said "needs keys" "$work/err"
chmod 644 "$work/keys/coupler.key_secret"
code=0
"$bin/coupler" run "$work/case.toml" --out "$work/no" --listen tcp://$near --await fem --keys "$work/keys" \
  2>"$work/err" || code=$?
check "no secret key that others may read" test "$code" = 65
check "its reason" said "others may read the secret key" "$work/err"
chmod 600 "$work/keys/coupler.key_secret"

# Nobody comes.
sed 's/^duration_s.*/&\nconnect_timeout_s = 1.0/' "$work/case.toml" >"$work/hasty.toml"
code=0
"$bin/coupler" run "$work/hasty.toml" --out "$work/hasty" --listen tcp://$near --await fem --keys "$work/keys" \
  2>"$work/err" || code=$?
check "an end to the waiting" test "$code" = 69
check "who was awaited where" said "fem (awaited at tcp://$near:.*) did not connect within 1 s" "$work/err"

# The run.
"$bin/coupler" run "$work/case.toml" --out "$work/out" --listen tcp://$near --await fem --keys "$work/keys" \
  2>"$work/coupler.err" >/dev/null &
coupler=$!
for ((i = 0; i < 300; i++)); do [[ -s $work/out/session ]] && break || sleep 0.1; done
check "the token is for its owner alone" test "$(stat -c %a "$work/out/session")" = 600

fem
check "no connection to another host without a key" test "$code" = 64
on_far /usr/bin/python3 - "$work/out/session" <<'PYTHON'
import sys, time, zmq
endpoint = open(sys.argv[1]).readline().split("'")[1]
dealer = zmq.Context().socket(zmq.DEALER)
dealer.setsockopt(zmq.LINGER, 0)
dealer.connect(endpoint)
time.sleep(0.5)
PYTHON
fem --key "$work/strangers/fem.key_secret" --server-key "$work/keys/coupler.key"
check "a stranger's key" test "$code" = 76
check "its reason" said "the coupler does not know this key" "$work/fem.log"
fem --key "$work/keys/qdem.key_secret" --server-key "$work/keys/coupler.key"
check "the key of another role" test "$code" = 76
fem --key "$work/keys/fem.key_secret" --server-key "$work/strangers/coupler.key"
check "another coupler's key" test "$code" = 76
fem --key "$work/keys/fem.key_secret" --server-key "$work/keys/coupler.key"
check "the right key" test "$code" = 0
code=0
wait $coupler || code=$?
check "the run" test "$code" = 0
# Which end notices first that there is no key is a matter of time.
for text in "shows no key\|as one without a key does" "is not on the list" "made for another coupler's key"; do
  check "in the log: $text" said "$text" "$work/out/run.log"
done
check "the token is gone" test ! -e "$work/out/session"
secret=$(sed -n 's/.*secret-key = "\(.*\)"/\1/p' "$work/keys/fem.key_secret")
check "no secret in what was written" test -z "$(grep -rlF -- "$secret" "$work/out" "$work/fem.log" "$work/coupler.err")"

# The wire changes nothing.
"$bin/coupler" run "$work/case.toml" --out "$work/local" >/dev/null
hash_of() { /usr/bin/python3 -c "import json; print(json.load(open('$1/summary.json'))['interface']['hash'])"; }
check "the bits of a run on one host" test "$(hash_of "$work/out")" = "$(hash_of "$work/local")"

((failures == 0)) && echo "two hosts: all right" && exit 0
cat "$work/out/run.log" "$work/coupler.err" "$work/fem.log"
exit 1
