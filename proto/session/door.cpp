#include "proto/session/door.hpp"

#include "proto/error.hpp"

namespace proto {

Door make_door(const std::string& address, const std::string& keys, const std::set<std::string>& names) {
  const std::string scheme = "tcp://";
  Door door;
  if (address.empty()) return door;
  if (address.rfind(scheme, 0) != 0)
    throw Error(ExitCode::usage, "the address to listen at is not of TCP", address, "give tcp://HOST[:PORT]");
  if (keys.empty() && needs_keys(address))
    throw Error(ExitCode::usage, "an address that other machines can reach needs keys", address,
                "make them with 'coupler keys DIR' and give --keys DIR, or listen at tcp://127.0.0.1");
  const bool has_port = address.find(':', scheme.size()) != std::string::npos;
  door.address = has_port ? address : address + ":*";
  if (keys.empty()) return door;
  door.key = read_key_pair(keys + "/coupler.key_secret");
  for (const auto& name : names) door.allowed[name] = read_public_key(keys + "/" + name + ".key");
  return door;
}

}  // namespace proto
