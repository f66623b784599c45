// What a window costs beyond the solvers' computing: two exchanges over ipc, from the coupler's request to the
// participant's decoded result.
#include <algorithm>
#include <cstdio>

#include "tests/integration/session_harness.hpp"

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t n_fields = 4;
const char* const field_names[] = {"a", "b", "c", "d"};

/// Gives back the fields it is given.
struct Echo : tests::MockParticipant {
  explicit Echo(std::size_t n) : n_cells(n), n_values(3 * n) {}
  proto::Interface describe() override {
    proto::SeatRegistration seat;
    seat.name = "seat";
    seat.points.assign(n_values, 0.0);
    seat.weights.assign(n_cells, 1.0 / n_cells);
    seat.rigid_response.assign(6 * n_values, 0.0);
    seat.force_resultants.assign(6 * n_values, 0.0);
    proto::Interface interface;
    interface.seats = {seat};
    for (const char* name : field_names) interface.fields.push_back({name, "1", 3, true});
    return interface;
  }
  proto::FieldSet start() override { return {}; }
  proto::FieldSet advance(const proto::Advance& request, proto::Progress&) override { return request.data; }
  std::size_t n_cells, n_values;
};

class CouplerOverhead : public tests::SessionHarness {
 protected:
  /// Seconds of one exchange beyond the participant's computing.
  double exchange(std::int64_t number, const proto::FieldSet& data) {
    auto request = window(number);
    request.data = data;
    const auto begin = Clock::now();
    const auto result = ask<proto::Result>(request);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    endpoint->send("mock", proto::Commit{number});
    EXPECT_EQ(result.data.all().size(), n_fields);
    return seconds - result.compute_s;
  }

  /// Least and median overhead of a window [s].
  std::pair<double, double> measure(std::size_t n_cells) {
    constexpr int n_windows = 300;
    open_again();
    Echo echo(n_cells);
    auto served = serve_in_thread(echo, options());
    configure(2 * n_windows);
    ask<proto::Result>(proto::Start{});
    proto::FieldSet data;
    for (const char* name : field_names) data.set(name, std::vector<double>(echo.n_values, 1.5));
    std::vector<double> windows;
    for (std::int64_t n = 0; n < n_windows; ++n) windows.push_back(exchange(2 * n, data) + exchange(2 * n + 1, data));
    ask<proto::Bye>(proto::Finish{});
    EXPECT_EQ(served.get().code, 0);
    std::sort(windows.begin(), windows.end());
    return {windows.front(), windows[n_windows / 2]};
  }
};

TEST_F(CouplerOverhead, OfTwoExchanges) {
  // 4 fields each way; together 2, 64 and 128 KiB an exchange.
  for (const std::size_t n_cells : {10u, 341u, 682u}) {
    const auto [least, median] = measure(n_cells);
    const double kib = 2.0 * n_fields * 3.0 * static_cast<double>(n_cells * sizeof(double)) / 1024.0;
    std::printf("two exchanges of %.1f KiB, request and answer: least %.3f ms, median %.3f ms\n", kib, 1e3 * least,
                1e3 * median);
  }
}

}  // namespace
