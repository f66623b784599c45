// Device memory and the backend that checks kernels: what is wrong must show.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "qdem_solver/engine/device/buffer.hpp"
#include "qdem_solver/engine/device/check_backend.hpp"

namespace {

using qdem::device::Access;
using qdem::device::CheckBackend;
using qdem::device::Pointer;
using Values = qdem::device::Buffer<CheckBackend, double>;

template <class T, class = void>
struct Dereferences : std::false_type {};
template <class T>
struct Dereferences<T, std::void_t<decltype(*std::declval<T>())>> : std::true_type {};
template <class T, class = void>
struct Indexes : std::false_type {};
template <class T>
struct Indexes<T, std::void_t<decltype(std::declval<T>()[0])>> : std::true_type {};

static_assert(Dereferences<double*>::value && Indexes<double*>::value, "the questions are the right ones");
static_assert(!Dereferences<Pointer<double>>::value && !Indexes<Pointer<double>>::value);
static_assert(!std::is_convertible_v<Pointer<double>, double*>);
static_assert(!std::is_constructible_v<Pointer<double>, double*>, "host memory does not pass for device memory");
static_assert(!std::is_default_constructible_v<Access>, "host code cannot make the right to look");
static_assert(std::is_convertible_v<Pointer<double>, Pointer<const double>>);
static_assert(!std::is_convertible_v<Pointer<const double>, Pointer<double>>);
static_assert(!std::is_copy_constructible_v<Values>, "copies are explicit");

/// Twice the input: every item its own value.
struct Doubled {
  Pointer<const double> in;
  Pointer<double> out;
  void operator()(const Access& at, std::int64_t i) const { at(out)[i] = 2 * at(in)[i]; }
};

/// Reads what another item writes.
struct RunningSum {
  Pointer<double> values;
  void operator()(const Access& at, std::int64_t i) const {
    if (i > 0) at(values)[i] += at(values)[i - 1];
  }
};

std::vector<double> ascending(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

template <class Use>
std::vector<double> results(std::uint64_t seed, const Use& use) {
  CheckBackend backend(seed);
  Values in(ascending(100)), out(100);
  use(backend, in, out);
  return out.get();
}

}  // namespace

TEST(DeviceMemory, CopiesGoInAndOut) {
  Values memory(ascending(5));
  EXPECT_EQ(memory.get(), ascending(5));
  EXPECT_EQ(memory.value(3), 4.0);
  Values copy = memory.copy();
  memory.put(std::vector<double>{7.0});
  EXPECT_EQ(memory.size(), 1u);
  EXPECT_EQ(copy.get(), ascending(5));
}

TEST(DeviceMemory, IsNotANumberBeforeItIsWritten) {
  for (const double value : Values(10).get()) EXPECT_TRUE(std::isnan(value));
  Values memory(ascending(10));
  memory.resize(10);
  for (const double value : memory.get()) EXPECT_TRUE(std::isnan(value)) << "resize() keeps nothing";
}

TEST(CheckBackend, IndependentItemsGiveTheSameInAnyOrder) {
  const auto doubled = [](CheckBackend& backend, Values& in, Values& out) {
    backend.run(Doubled{in.data(), out.data()}, 100);
  };
  EXPECT_EQ(results(0, doubled), results(7, doubled));
  EXPECT_EQ(results(0, doubled)[9], 20.0);
}

TEST(CheckBackend, FindsAKernelThatDependsOnTheOrder) {
  const auto sums = [](CheckBackend& backend, Values& in, Values& out) {
    backend.run(RunningSum{in.data()}, 100);
    out = in.copy();
  };
  EXPECT_EQ(results(0, sums)[99], 5050.0);
  EXPECT_NE(results(0, sums), results(7, sums));
}

TEST(CheckBackend, FindsAKernelThatReadsWhatNobodyWrote) {
  const auto unwritten = [](CheckBackend& backend, Values&, Values& out) {
    const Values nothing(100);
    backend.run(Doubled{nothing.data(), out.data()}, 100);
  };
  EXPECT_TRUE(std::isnan(results(0, unwritten)[0]));
}

TEST(CheckBackend, SortsScansAndKeepsUniqueValues) {
  CheckBackend backend(1);
  qdem::device::Buffer<CheckBackend, int> keys(std::vector<int>{3, 1, 3, 2, 1}),
      values(std::vector<int>{0, 1, 2, 3, 4});
  backend.sort_by_key(keys.data(), values.data(), 5);
  EXPECT_EQ(values.get(), (std::vector<int>{1, 4, 3, 0, 2})) << "stable";
  EXPECT_EQ(backend.unique(keys.data(), 5), 3);
  backend.scan(values.data(), 5);
  EXPECT_EQ(values.get(), (std::vector<int>{0, 1, 5, 8, 8}));
}
