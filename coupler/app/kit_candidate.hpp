// What the kit's subcommands have in common: a participant to start, and a folder for it.
#pragma once

#include <string>
#include <vector>

#include "coupler/conformance/bench.hpp"

namespace coupler {

/// The participant `name` of the case, started by `command`, or as the case says if that is empty.
/// Throws proto::Error (config, missing_input).
conformance::Candidate find_candidate(const std::string& case_path, const std::string& name,
                                      const std::vector<std::string>& command);

/// Where the participant writes: a folder that is asked for stays, one of our own goes unless it is kept.
class Workplace {
 public:
  /// `wanted`: a folder that is not there yet; empty: a temporary one. Throws proto::Error (cannot_create).
  explicit Workplace(const std::string& wanted);
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  const std::string& path() const { return path_; }  ///< absolute
  void keep() { keep_ = true; }

 private:
  bool own_, keep_ = false;
  std::string path_;
};

}  // namespace coupler
