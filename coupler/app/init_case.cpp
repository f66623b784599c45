// `coupler init`: a case of one's own to start from.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "coupler/app/kit.hpp"
#include "coupler/app/shipped_cases.hpp"
#include "proto/error.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

constexpr const char* usual = "wheel_passage_quick";

std::vector<std::string> names_of_shipped() {
  std::vector<std::string> names;
  for (const auto& shipped : shipped_cases()) names.push_back(shipped.name);
  return names;
}

int init_case(const std::string& folder, const std::string& from) {
  const auto path = fs::path(folder) / "case.toml";
  if (fs::exists(path))
    throw proto::Error(proto::ExitCode::cannot_create, "there is a case already", path.string(), "give another name");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw proto::Error(proto::ExitCode::cannot_create, "cannot create the folder (" + error.message() + ")", folder);
  const auto& all = shipped_cases();
  const auto source = std::find_if(all.begin(), all.end(), [&](const ShippedCase& c) { return c.name == from; });
  proto::write_text_file(path.string(), source->text);
  fmt::print("{} is a copy of the case {}. Change it, then\n  coupler check {}\n  coupler run {}\n", path.string(),
             from, path.string(), path.string());
  return 0;
}

}  // namespace

void add_init_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("init", "make a commented case to start from");
  const auto folder = std::make_shared<std::string>(), from = std::make_shared<std::string>(usual);
  command->add_option("NAME", *folder, "folder of the new case")->required();
  command->add_option("--from", *from, "shipped case that it is a copy of")
      ->check(CLI::IsMember(names_of_shipped()))
      ->capture_default_str();
  command->callback([folder, from, &chosen] { chosen = [folder, from] { return init_case(*folder, *from); }; });
}

}  // namespace coupler
