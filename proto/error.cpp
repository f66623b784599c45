#include "proto/error.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace proto {
namespace {

std::string compose(const std::string& problem, const std::string& where, const std::string& advice) {
  std::string text = problem;
  if (!where.empty()) text += " - " + where;
  if (!advice.empty()) text += " - " + advice;
  return text;
}

}  // namespace

Error::Error(ExitCode code, const std::string& problem, const std::string& where, const std::string& advice)
    : std::runtime_error(compose(problem, where, advice)), code_(code) {}

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row[b.size()];
}

}  // namespace proto
