// A device that is only imagined: kernels run on the host, on copies of the data, in any order.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>
#include <type_traits>
#include <vector>

#include "qdem_solver/engine/device/algorithms.hpp"

namespace qdem::device {

/// Runs every kernel item by item. "Device" memory is separate and starts as NaN (all bits set), and so does what a
/// caller forgets. A result that depends on the order of the items, on memory never written, or on what lies in host
/// memory differs from the straight run, or is NaN.
class CheckBackend : public Algorithms<CheckBackend> {
 public:
  /// seed 0: items in ascending order; otherwise in a random one, another for every launch.
  explicit CheckBackend(std::uint64_t seed) : straight_(seed == 0), random_(seed) {}

  template <class T>
  static Pointer<T> allocate(std::size_t n) {
    return Access::pointer(n == 0 ? nullptr : static_cast<T*>(std::malloc(n * sizeof(T))));
  }
  template <class T>
  static void release(Pointer<T> memory) {
    std::free(raw(memory));
  }
  template <class T>
  static void forget(Pointer<T> memory, std::size_t n) {
    if (n > 0) std::memset(static_cast<void*>(raw(memory)), 0xff, n * sizeof(T));
  }
  template <class T>
  static void to_device(Pointer<T> to, const T* from, std::size_t n) {
    if (n > 0) std::memcpy(static_cast<void*>(raw(to)), from, n * sizeof(T));
  }
  template <class T>
  static void to_host(T* to, Pointer<const T> from, std::size_t n) {
    if (n > 0) std::memcpy(static_cast<void*>(to), raw(from), n * sizeof(T));
  }
  template <class T>
  static void between(Pointer<T> to, Pointer<const T> from, std::size_t n) {
    if (n > 0) std::memcpy(static_cast<void*>(raw(to)), raw(from), n * sizeof(T));
  }
  /// Spoils values in host memory that the device has its own copy of.
  static void spoil(std::vector<double>& values) { std::memset(values.data(), 0xff, values.size() * sizeof(double)); }

  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t n_items) {
    static_assert(std::is_trivially_copyable_v<Kernel>);
    const Access at;
    if (straight_) {
      for (std::int64_t item = 0; item < n_items; ++item) kernel(at, item);
      return;
    }
    order_.resize(n_items);
    std::iota(order_.begin(), order_.end(), 0);
    std::shuffle(order_.begin(), order_.end(), random_);
    for (const std::int64_t item : order_) kernel(at, item);
  }
  template <class Step>
  void repeat(std::int64_t n, const Step& step) {
    for (std::int64_t i = 0; i < n; ++i) step();
  }

 private:
  friend class Algorithms<CheckBackend>;

  static auto policy() { return thrust::cpp::par; }
  template <class T>
  static T* raw(Pointer<T> pointer) {
    return Access()(pointer);
  }

  bool straight_;
  std::mt19937_64 random_;
  std::vector<std::int64_t> order_;
};

}  // namespace qdem::device
