// `coupler keys`: keys for participants on other machines.
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "coupler/app/kit.hpp"
#include "proto/error.hpp"
#include "proto/session/curve_keys.hpp"

namespace coupler {
namespace {

int make_keys(const std::string& folder) {
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST)
    throw proto::Error(proto::ExitCode::cannot_create,
                       std::string("the folder cannot be made: ") + std::strerror(errno), folder);
  for (const char* name : {"coupler", "qdem", "fem"}) {
    proto::write_key_pair(folder, name, proto::make_key_pair());
    fmt::print("{0}/{1}.key_secret  {0}/{1}.key\n", folder, name);
  }
  return 0;
}

}  // namespace

void add_keys_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("keys", "make keys for participants on other machines (run --listen --keys)");
  const auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "folder to write coupler, qdem and fem .key and .key_secret to")->required();
  command->callback([folder, &chosen] { chosen = [folder] { return make_keys(*folder); }; });
}

}  // namespace coupler
