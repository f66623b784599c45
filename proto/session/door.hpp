// A way in to the coupler beside its ipc socket, for participants that cannot reach that.
#pragma once

#include <map>
#include <set>
#include <string>

#include "proto/session/curve_keys.hpp"

namespace proto {

/// Made by make_door(), which sees to it that nobody comes in without a key from another machine.
struct Door {
  std::string address;                         ///< for ZeroMQ's bind; empty: no door
  KeyPair key;                                 ///< the coupler's; empty: neither encrypted nor authenticated
  std::map<std::string, std::string> allowed;  ///< with a key: public keys by the name of their participant
};

/// A door at `address`, "tcp://HOST" (any free port) or "tcp://HOST:PORT"; none when it is empty. `keys`: folder of
/// coupler.key_secret and of a NAME.key of each of `names`; empty: no keys.
/// Throws proto::Error: usage for another kind of address, and for one that others can reach when there are no keys;
/// what read_key_pair() throws.
Door make_door(const std::string& address, const std::string& keys, const std::set<std::string>& names);

}  // namespace proto
