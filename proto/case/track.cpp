#include "proto/case/track.hpp"

namespace proto {

Track read_track(const CaseFile& file) {
  const auto section = file.section("track");
  Track track;
  track.gauge = section.number("gauge_m", Range::positive());
  track.sleeper_spacing = section.number("sleeper_spacing_m", Range::positive());
  section.finish();
  return track;
}

}  // namespace proto
