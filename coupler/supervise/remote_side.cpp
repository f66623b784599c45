#include "coupler/supervise/remote_side.hpp"

#include <fmt/format.h>

namespace coupler {

proto::Result RemoteSide::advance(const proto::Advance& request) {
  auto result = supervisor_.await<proto::Result>(name_, supervisor_.send(name_, request));
  if (result.window != request.window || result.iteration != request.iteration || result.phase != request.phase)
    throw ParticipantError(name_, proto::ExitCode::protocol,
                           fmt::format("{} answered for window {} iteration {} instead of window {} iteration {}",
                                       name_, result.window, result.iteration, request.window, request.iteration),
                           supervisor_.stage());
  return result;
}

}  // namespace coupler
