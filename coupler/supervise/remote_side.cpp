#include "coupler/supervise/remote_side.hpp"

#include <fmt/format.h>

namespace coupler {

proto::Result RemoteSide::advance(const proto::Advance& request) {
  begin(request);
  return end();
}

void RemoteSide::begin(const proto::Advance& request) {
  ticket_ = supervisor_.send(name_, request);
  phase_ = request.phase, window_ = request.window, iteration_ = request.iteration;
}

proto::Result RemoteSide::end() {
  auto result = supervisor_.await<proto::Result>(name_, ticket_);
  if (result.window != window_ || result.iteration != iteration_ || result.phase != phase_)
    refuse(fmt::format("{} answered for window {} iteration {} instead of window {} iteration {}", name_, result.window,
                       result.iteration, window_, iteration_));
  if (phase_ == proto::Phase::initialise) check_residual(result.residual);
  return result;
}

void RemoteSide::check_residual(const std::optional<double>& residual) const {
  const char* advice = "a participant that offers to initialise gives one of at least 0 in every result of that phase";
  if (!residual) refuse(name_ + " gave no residual", advice);
  if (*residual < 0.0) refuse(fmt::format("{} gave the residual {}", name_, *residual), advice);
}

void RemoteSide::refuse(const std::string& problem, const std::string& advice) const {
  throw ParticipantError(name_, proto::ExitCode::protocol, problem, supervisor_.stage(), advice);
}

}  // namespace coupler
