// contacts.h5: which bodies pressed on each other, and how hard.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "proto/result/attributes.hpp"
#include "proto/result/time_series.hpp"
#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// A file of its own since the number of contacts changes: a history with one row for every pair of bodies that touch
/// at an output. Columns: time [s], body_a, body_b (numbers as in qdem.h5; body_b = -1 - n for plane n), contacts
/// (places at which the two touch), force [N] of the pair on body_a, global axes. Rows are ascending by time, body_a,
/// body_b.
class ContactsFile {
 public:
  /// Creates `path`. Throws proto::Error (cannot_create).
  ContactsFile(const std::string& path, const proto::Attributes& attributes);

  /// Goes on with the file that an earlier process made, after its first `n_rows` rows.
  static ContactsFile resume(const std::string& path, const proto::Attributes& attributes, std::uint64_t n_rows);

  /// Appends the pairs that touch at `time` [s]; `contacts` holds the forces of `state`. Throws proto::Error
  /// (io_error).
  void write(double time, const State& state, const ContactStage& contacts);
  std::uint64_t n_rows() const { return file_.n_rows(); }
  /// What was written is safe against a loss of power.
  void synchronise() { file_.synchronise(); }
  void close() { file_.close(); }

 private:
  explicit ContactsFile(proto::TimeSeriesFile file) : file_(std::move(file)) {}

  proto::TimeSeriesFile file_;
};

}  // namespace qdem
