// A writer killed with SIGKILL at a random instant: its file opens and holds every step that was committed.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

#include "proto/result/reader.hpp"
#include "proto/result/xdmf.hpp"
#include "tests/support/result_samples.hpp"

namespace {

constexpr int n_trials = 40;
constexpr std::size_t n_cells = 3000;  // several chunks beyond HDF5's cache of one MiB after a few steps

/// Tells the parent how many rows or steps are safe.
using Acknowledge = std::function<void(std::uint64_t)>;
using Writer = std::function<void(const Acknowledge&)>;

/// Runs `writer` in a child, kills it `delay` after it is ready; returns the last acknowledged count.
std::uint64_t kill_after(const Writer& writer, std::chrono::microseconds delay) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    writer([&](std::uint64_t count) {
      if (::write(ends[1], &count, sizeof count) != sizeof count) _exit(1);
    });
    _exit(0);
  }
  ::close(ends[1]);
  std::uint64_t acknowledged = 0, count = 0;
  if (::read(ends[0], &count, sizeof count) != sizeof count) throw std::runtime_error("the writer did not start");
  std::this_thread::sleep_for(delay);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the writer ended before it was killed";
  while (::read(ends[0], &count, sizeof count) == sizeof count) acknowledged = count;
  ::close(ends[0]);
  return acknowledged;
}

std::chrono::microseconds random_delay(std::mt19937_64& generator) {
  return std::chrono::microseconds(generator() % 20000);
}

TEST(WriterKilled, HistoryHoldsEveryCommittedRow) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("coupling.h5");
  std::mt19937_64 generator(1);
  std::uint64_t largest = 0;
  for (int trial = 0; trial < n_trials; ++trial) {
    const std::uint64_t acknowledged = kill_after(
        [&](const Acknowledge& acknowledge) {
          auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), {}, 5);
          acknowledge(0);
          for (std::size_t row = 0;; ++row) {
            tests::write_sample_row(file, row);
            acknowledge(file.n_committed());
          }
        },
        random_delay(generator));
    const proto::ResultReader reader(path);
    const std::uint64_t committed = reader.n_committed();
    ASSERT_GE(committed, acknowledged) << "trial " << trial;
    ASSERT_EQ(committed % 5, 0u) << "a commit is all or nothing";
    const auto times = reader.read_rows("/time", committed).values;
    const auto impulses = reader.read_rows("/seats/seat/impulse", committed).values;
    for (std::size_t row = 0; row < committed; ++row) {
      ASSERT_EQ(times[row], 5e-5 * static_cast<double>(row)) << "trial " << trial;
      const auto expected = tests::sample_row(row);
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), impulses.begin() + 27 * row)) << "trial " << trial;
    }
    largest = std::max(largest, committed);
  }
  EXPECT_GT(largest, 20u) << "the trials killed too early to show anything";
}

TEST(WriterKilled, FieldsHoldEveryCommittedStepAndGetTheirSidecar) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("qdem.h5");
  std::mt19937_64 generator(2);
  std::uint64_t largest = 0;
  for (int trial = 0; trial < n_trials; ++trial) {
    const std::uint64_t acknowledged = kill_after(
        [&](const Acknowledge& acknowledge) {
          auto file = proto::FieldSeriesFile::create(path, tests::sample_fields(n_cells));
          acknowledge(0);
          for (std::size_t step = 0;; ++step) {
            tests::write_sample_step(file, step, n_cells);
            acknowledge(file.n_steps());
          }
        },
        random_delay(generator));
    const proto::ResultReader reader(path);
    const std::uint64_t steps = reader.n_steps();
    ASSERT_GE(steps, acknowledged) << "trial " << trial;
    const auto displacement = reader.read_rows("/VTKHDF/PointData/displacement", steps * 4 * n_cells).values;
    const auto stress = reader.read_rows("/VTKHDF/CellData/stress", steps * n_cells).values;
    for (std::size_t step = 0; step < steps; ++step) {
      for (std::size_t i = 0; i < n_cells; ++i) {
        ASSERT_EQ(stress[step * n_cells + i], tests::sample_value(step, i)) << "trial " << trial << " step " << step;
      }
      for (std::size_t i = 0; i < 12 * n_cells; ++i) {
        ASSERT_EQ(displacement[step * 12 * n_cells + i], tests::sample_value(step, i)) << "trial " << trial;
      }
    }
    ASSERT_GE(reader.n_committed("/TimeSeries"), steps);
    proto::write_xdmf(path);
    if (steps > 0) {
      const proto::ResultReader views(folder.file("qdem.views.h5"));
      const auto last = views.read("/step_" + std::to_string(steps - 1) + "/cells/stress").values;
      ASSERT_EQ(last.at(n_cells - 1), tests::sample_value(steps - 1, n_cells - 1));
    }
    largest = std::max(largest, steps);
  }
  EXPECT_GT(largest, 3u) << "the trials killed too early to show anything";
}

}  // namespace
