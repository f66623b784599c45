// What the suite tests, and what its checks share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/coupling.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/wire/messages.hpp"

namespace coupler::conformance {

/// The participant under test and its case.
struct Candidate {
  std::string name;                  ///< "qdem" or "fem": the role it plays
  std::vector<std::string> command;  ///< absolute path of the program, arguments
  std::string case_path;
  std::uint64_t case_hash = 0;
  proto::Coupling coupling;
  std::vector<proto::RailSeat> seats;
  double amplitude_m = 1e-5;  ///< of the motion that the other side is made to have
  bool is_explicit() const { return name == "qdem"; }
};

/// An undisturbed march from Start.
struct Reference {
  proto::Capabilities capabilities;
  proto::Result initial;
  std::vector<proto::Result> windows;
};

class Bench {
 public:
  /// `folder` exists and takes what the participant writes.
  Bench(Candidate candidate, std::string folder) : candidate_(std::move(candidate)), folder_(std::move(folder)) {}

  const Candidate& candidate() const { return candidate_; }

  /// A new, empty folder for one start of the participant. Throws proto::Error (cannot_create).
  std::string new_folder();

  /// Six windows, run when they are first asked for. Throws proto::Error when the participant fails in them.
  const Reference& reference();

 private:
  Candidate candidate_;
  std::string folder_;
  int n_folders_ = 0;
  std::optional<Reference> reference_;
};

}  // namespace coupler::conformance
