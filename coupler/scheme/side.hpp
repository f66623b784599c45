// What a coupling scheme needs of a participant. The scheme decides when and what; how it travels is not its matter.
#pragma once

#include <utility>

#include "proto/wire/messages.hpp"

namespace coupler {

/// One participant as a scheme sees it: remote in a run, a model in a test.
class Side {
 public:
  virtual ~Side() = default;

  /// Solves one window and returns its values. Throws proto::Error when the participant fails or is lost.
  virtual proto::Result advance(const proto::Advance& request) = 0;

  /// advance() in two halves, so that two sides can work at the same time: begin both, then end both. A side in this
  /// process does all its work in begin().
  virtual void begin(const proto::Advance& request) { begun_ = advance(request); }
  virtual proto::Result end() { return std::move(begun_); }

  /// Back to the last commit: the window is solved again, with the next iteration number.
  virtual void rollback(const proto::Rollback& request) = 0;

  /// Makes the window just advanced final.
  virtual void commit(const proto::Commit& request) = 0;

 private:
  proto::Result begun_;
};

/// The two participants of a run, by what they do.
struct Sides {
  Side& implicit_side;  ///< rail: takes the predicted sleeper or a force, gives displacement and force
  Side& explicit_side;  ///< sleeper: takes the rail's displacement, gives the impulse of the pad force
};

}  // namespace coupler
