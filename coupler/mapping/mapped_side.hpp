// A rail's side with points of its own, as a coupling scheme sees it: at the pad's cells.
#pragma once

#include <utility>
#include <vector>

#include "coupler/mapping/pad_map.hpp"
#include "coupler/scheme/side.hpp"

namespace coupler {

/// What a participant with points of its own is asked in the place of `request`.
proto::Advance at_points(const PadMap& map, proto::Advance request);

/// Its motion at the cells.
proto::FieldSet at_cells(const PadMap& map, proto::FieldSet motion);

/// Its answer to `request` (as it was before at_points()), at the cells. Throws proto::Error (protocol) when the force
/// that loaded it is not the given one.
proto::Result at_cells(const PadMap& map, proto::Result result, const proto::Advance& request);

/// Forces that are given (mean, joint) go to the points, motions come from them. The pad's own values in the mode robin
/// are the cells' on the wire too: that side has the operator in its pad (Configure.pad_map).
class MappedSide : public Side {
 public:
  /// `side` must outlive the object.
  MappedSide(Side& side, PadMap map) : side_(side), map_(std::move(map)) {}

  proto::Result advance(const proto::Advance& request) override;
  void begin(const proto::Advance& request) override;
  proto::Result end() override;
  void rollback(const proto::Rollback& request) override { side_.rollback(request); }
  void commit(const proto::Commit& request) override { side_.commit(request); }

  const PadMap& map() const { return map_; }

 private:
  Side& side_;
  PadMap map_;
  proto::Advance request_;  ///< that was begun
};

}  // namespace coupler
