#include "coupler/conformance/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "proto/clock.hpp"
#include "proto/error.hpp"

namespace coupler::conformance {
namespace {

std::vector<Check> gather_checks() {
  std::vector<Check> all;
  for (const auto& group : {handshake_checks(), window_checks(), state_checks(), message_checks(), process_checks()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

bool is_for(const Check& check, const Candidate& candidate) {
  return check.role == Role::both || (check.role == Role::qdem) == candidate.is_explicit();
}

Verdict verdict_of(const Check& check, Bench& bench) {
  try {
    return check.run(bench);
  } catch (const proto::Error& error) {
    return fail(error.what());
  }
}

const char* name_of(Outcome outcome) {
  return outcome == Outcome::pass ? "pass" : outcome == Outcome::fail ? "fail" : "not offered";
}

}  // namespace

const std::vector<Check>& all_checks() {
  static const auto checks = gather_checks();
  return checks;
}

std::vector<Finding> run_suite(Bench& bench, const std::set<std::string>& only,
                               const std::function<void(const Finding&)>& tell) {
  std::vector<Finding> findings;
  for (const auto& check : all_checks()) {
    if (!is_for(check, bench.candidate()) || (!only.empty() && !only.count(check.name))) continue;
    const auto begin = std::chrono::steady_clock::now();
    Finding finding{&check, verdict_of(check, bench), 0.0};
    finding.seconds = proto::seconds_since(begin);
    tell(finding);
    findings.push_back(finding);
  }
  return findings;
}

bool conforms(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const auto& finding) { return finding.verdict.outcome == Outcome::fail; });
}

std::string report_line(const Finding& finding) {
  const auto& reason = finding.verdict.reason;
  return fmt::format("{:<12}{:<18}{}\n{}", name_of(finding.verdict.outcome), finding.check->name, finding.check->what,
                     reason.empty() ? "" : fmt::format("{:30}{}\n", "", reason));
}

std::string report_json(const Candidate& candidate, const std::vector<Finding>& findings) {
  auto checks = nlohmann::json::array();
  for (const auto& finding : findings)
    checks.push_back({{"name", finding.check->name},
                      {"what", finding.check->what},
                      {"outcome", name_of(finding.verdict.outcome)},
                      {"reason", finding.verdict.reason},
                      {"seconds", finding.seconds}});
  const nlohmann::json report{{"participant", candidate.name},
                              {"command", candidate.command},
                              {"case", candidate.case_path},
                              {"conforms", conforms(findings)},
                              {"checks", checks}};
  // Texts of a participant may hold any bytes.
  return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace coupler::conformance
