// A participant in another process, as a coupling scheme sees it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coupler/scheme/side.hpp"
#include "coupler/supervise/supervisor.hpp"

namespace coupler {

/// Sends Advance, Rollback and Commit; checks that the result is of the window that was asked for, and has a residual
/// in the initialise phase.
class RemoteSide : public Side {
 public:
  RemoteSide(Supervisor& supervisor, std::string name) : supervisor_(supervisor), name_(std::move(name)) {}

  proto::Result advance(const proto::Advance& request) override;
  /// The participant computes while the caller goes on.
  void begin(const proto::Advance& request) override;
  proto::Result end() override;
  void rollback(const proto::Rollback& request) override { supervisor_.send(name_, request); }
  void commit(const proto::Commit& request) override { supervisor_.send(name_, request); }

 private:
  void check_residual(const std::optional<double>& residual) const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& advice = {}) const;

  Supervisor& supervisor_;
  std::string name_;
  std::uint64_t ticket_ = 0;  ///< of the request that was begun
  proto::Phase phase_ = proto::Phase::march;
  std::int64_t window_ = 0;
  std::uint32_t iteration_ = 0;
};

}  // namespace coupler
