// Outputs that cannot be created or written: one error with the path, no signal, and what was committed stays readable.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/result_samples.hpp"

namespace {

/// Calls of pwrite() that succeed from now on; negative: all.
long n_good_writes = -1;
/// Writes to places behind this one fail, others succeed: a disk without a free block.
off_t last_block_end = std::numeric_limits<off_t>::max();

}  // namespace

/// Stands before the C library's function, which HDF5 calls for every write: from a chosen call on the disk is full.
/// The first failing call still writes half of its bytes, as a disk that runs full does.
extern "C" ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  if (n_good_writes == 0 || offset >= last_block_end) {
    errno = ENOSPC;
    return -1;
  }
  if (n_good_writes > 0 && --n_good_writes == 0) size = (size + 1) / 2;
  if (offset + static_cast<off_t>(size) > last_block_end) size = static_cast<size_t>(last_block_end - offset);
  return ::syscall(SYS_pwrite64, file, data, size, offset);
}

namespace {

/// How a child that ran `action` ended: its proto::Error's code by an ordinary exit (exit handlers run, as in a
/// program), or the signal that killed it.
int wait_status_of(const std::function<void()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    int code = 0;
    try {
      action();
    } catch (const proto::Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      code = static_cast<int>(error.code());
    }
    std::exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

void expect_io_error(int status) {
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(proto::ExitCode::io_error));
}

void write_rows_without_end(const std::string& path) {
  auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), {}, 5);
  for (std::size_t row = 0;; ++row) tests::write_sample_row(file, row);
}

/// Number of committed rows, each with its right value.
std::uint64_t whole_rows(const std::string& path) {
  const proto::ResultReader reader(path);
  const std::uint64_t committed = reader.n_committed();
  const auto impulses = reader.read_rows("/seats/seat/impulse", committed).values;
  for (std::size_t row = 0; row < committed; ++row) {
    const auto expected = tests::sample_row(row);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), impulses.begin() + 27 * row)) << "row " << row;
  }
  return committed;
}

// Fails the k-th write for many k: in the middle of whatever HDF5 is doing, without a warning before.
TEST(DiskFull, FailingWriteAnywhereEndsWithOneErrorAndKeepsCommittedRows) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("coupling.h5");
  for (long k = 1; k <= 160; ++k) {
    const int status = wait_status_of([&] {
      auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), {}, 5);
      for (std::size_t row = 0; row < 200; ++row) tests::write_sample_row(file, row);
      n_good_writes = k;
      for (std::size_t row = 200;; ++row) tests::write_sample_row(file, row);
    });
    expect_io_error(status);
    EXPECT_GE(whole_rows(path), 200u) << "write " << k << " failed";
  }
}

// What is already on the disk can be rewritten, the file's header among it, but the file cannot grow: the header then
// promises a longer file than there is.
TEST(DiskFull, NoFreeBlockKeepsCommittedRows) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("coupling.h5");
  for (off_t more = 1; more <= 400000; more += 9973) {
    const int status = wait_status_of([&] {
      auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), {}, 5);
      for (std::size_t row = 0; row < 200; ++row) tests::write_sample_row(file, row);
      last_block_end = static_cast<off_t>(std::filesystem::file_size(path)) + more;
      for (std::size_t row = 200;; ++row) tests::write_sample_row(file, row);
    });
    expect_io_error(status);
    EXPECT_GE(whole_rows(path), 200u) << more << " bytes of room";
  }
}

TEST(DiskFull, FieldsSurviveTheSame) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("qdem.h5");
  for (long k = 1; k <= 80; ++k) {
    const int status = wait_status_of([&] {
      auto file = proto::FieldSeriesFile::create(path, tests::sample_fields(300));
      for (std::size_t step = 0; step < 10; ++step) tests::write_sample_step(file, step, 300);
      n_good_writes = k;
      for (std::size_t step = 10;; ++step) tests::write_sample_step(file, step, 300);
    });
    expect_io_error(status);
    const proto::ResultReader reader(path);
    const std::uint64_t steps = reader.n_steps();
    EXPECT_GE(steps, 10u) << "write " << k << " failed";
    const auto stress = reader.read_rows("/VTKHDF/CellData/stress", steps * 300).values;
    for (std::size_t step = 0; step < steps; ++step) {
      EXPECT_EQ(stress.at(step * 300 + 299), tests::sample_value(step, 299)) << "write " << k << " failed";
    }
  }
}

TEST(DiskFull, SmallFileSystem) {
  const tests::TemporaryFolder folder;
  if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=3m") != 0) {
    GTEST_SKIP() << "NOT RUN: a small file system cannot be mounted here (" << std::strerror(errno) << ")";
  }
  const std::string path = folder.file("coupling.h5");
  const int status = wait_status_of([&] { write_rows_without_end(path); });
  expect_io_error(status);
  EXPECT_GT(whole_rows(path), 1000u);
  EXPECT_EQ(::umount2(folder.path().c_str(), MNT_DETACH), 0);
}

TEST(DiskFull, NothingIsWrittenAfterTheFirstFailure) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("coupling.h5");
  const int status = wait_status_of([&] {
    auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), {}, 5);
    n_good_writes = 20;
    std::size_t row = 0;
    try {
      for (;; ++row) tests::write_sample_row(file, row);
    } catch (const proto::Error&) {
    }
    n_good_writes = -1;  // the disk has room again; the file is given up all the same
    const auto changed = std::filesystem::last_write_time(path);
    try {
      file.commit();
      std::exit(1);
    } catch (const proto::Error&) {
    }
    std::exit(std::filesystem::last_write_time(path) == changed ? 0 : 2);
  });
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_GT(whole_rows(path), 0u);
}

TEST(CannotCreate, InAFolderWithoutPermission) {
  const tests::TemporaryFolder folder;
  ::chmod(folder.path().c_str(), 0555);
  const int status = wait_status_of([&] {
    const bool is_root = ::geteuid() == 0;
    if (is_root && ::seteuid(65534) != 0) std::exit(1);  // root may write anywhere
    try {
      proto::TimeSeriesFile::create(folder.file("coupling.h5"), tests::sample_columns());
    } catch (const proto::Error&) {
      if (is_root && ::seteuid(0) != 0) std::exit(2);  // the leak sanitizer ends as the user it began as
      throw;
    }
  });
  ::chmod(folder.path().c_str(), 0755);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(proto::ExitCode::cannot_create));
}

}  // namespace
