// A run in words and numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace coupler::page {

/// Of the run in `folder`, as far as it left them: "name", "status", "summary" (summary.json), "question" (the comment
/// at the top of the case), "words" (sentences), "case_text", "wheel_radius" [m], "audit_limits", "warnings" (of the
/// logs), "provenance" (pairs). Where summary.json is not whole, a warning says so.
nlohmann::json run_facts(const std::string& folder);

/// The lines of comment at the top of a case file as one paragraph.
std::string leading_comment(const std::string& case_text);

/// Lines of a log that warn or name an error, at most `n_most` and then a line that says how many more there are.
std::vector<std::string> warnings_of(const std::string& log, std::size_t n_most);

}  // namespace coupler::page
