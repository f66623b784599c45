// One participant against the record of a run: it gets what it got then, and its answers are held against those of
// then.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "coupler/conformance/subject.hpp"
#include "coupler/record/frame_log.hpp"

namespace coupler::conformance {

/// How far one field of the results departs from the record.
struct Departure {
  double largest = 0.0;      ///< difference of a value, in the field's unit
  double magnitude = 0.0;    ///< largest value of the record
  std::int64_t window = -1;  ///< of the largest difference
  double relative() const { return magnitude > 0.0 ? largest / magnitude : largest; }
};

struct ReplayReport {
  std::uint64_t n_results = 0;
  std::string first_difference;  ///< in words, with its phase; "" when every answer has the record's bytes
  std::map<std::string, Departure> fields;
  double largest_relative() const;
};

/// Plays the first session of the record to its end. Saves are left out. Throws proto::Error: bad_data (the record is
/// of a resumed run, or damaged), ParticipantError when the participant fails or answers out of order.
ReplayReport replay(Subject& subject, FrameLogReader& log, const std::string& name, const std::string& folder);

/// For people; ends with a newline.
std::string replay_table(const ReplayReport& report);

}  // namespace coupler::conformance
