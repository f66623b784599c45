#include "qdem_solver/output/contacts_file.hpp"

#include <limits>

namespace qdem {
namespace {

// One output is one commit.
constexpr auto rows_per_commit = std::numeric_limits<std::size_t>::max();

std::vector<proto::Column> columns() {
  return {{"time", "s", "of the output", {}},
          {"body_a", "1", "number of the body", {}},
          {"body_b", "1", "number of the other body; -1 - n: plane n", {}},
          {"contacts", "1", "places at which the two touch", {}},
          {"force", "N", "of the pair on body_a, global axes", {3}}};
}

}  // namespace

ContactsFile::ContactsFile(const std::string& path, const proto::Attributes& attributes)
    : file_(proto::TimeSeriesFile::create(path, columns(), attributes, rows_per_commit)) {}

ContactsFile ContactsFile::resume(const std::string& path, const proto::Attributes& attributes, std::uint64_t n_rows) {
  return ContactsFile(proto::TimeSeriesFile::resume(path, n_rows, columns(), attributes, rows_per_commit));
}

void ContactsFile::write(double time, const State& state, const ContactStage& contacts) {
  for (const PairForce& pair : contacts.pair_forces(state)) {
    file_.put("time", time);
    file_.put("body_a", pair.body_a);
    file_.put("body_b", pair.body_b);
    file_.put("contacts", pair.n_contacts);
    file_.put("force", proto::Span<const double>(pair.force_a.data(), 3));
    file_.end_row();
  }
  file_.commit();
}

}  // namespace qdem
