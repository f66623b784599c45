// A participant in another process, as a coupling scheme sees it.
#pragma once

#include <optional>
#include <string>

#include "coupler/scheme/side.hpp"
#include "coupler/supervise/supervisor.hpp"

namespace coupler {

/// Sends Advance, Rollback and Commit; checks that the result is of the window that was asked for, and has a residual in the
/// initialise phase.
class RemoteSide : public Side {
 public:
  RemoteSide(Supervisor& supervisor, std::string name) : supervisor_(supervisor), name_(std::move(name)) {}

  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback& request) override { supervisor_.send(name_, request); }
  void commit(const proto::Commit& request) override { supervisor_.send(name_, request); }

 private:
  void check_residual(const std::optional<double>& residual) const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& advice = {}) const;

  Supervisor& supervisor_;
  std::string name_;
};

}  // namespace coupler
