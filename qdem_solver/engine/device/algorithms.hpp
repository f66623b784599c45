// Sort, scan and unique over device memory: Thrust, by the backend's execution policy.
#pragma once

#if !defined(__CUDACC__)
#define THRUST_DEVICE_SYSTEM THRUST_DEVICE_SYSTEM_CPP  // otherwise Thrust wants CUDA's headers
#endif
#include <thrust/execution_policy.h>
#include <thrust/scan.h>
#include <thrust/sort.h>
#include <thrust/unique.h>

#include "qdem_solver/engine/device/pointer.hpp"

namespace qdem::device {

/// Base of a backend, which has policy() and raw().
template <class Backend>
class Algorithms {
 public:
  template <class Key>
  void sort(Pointer<Key> keys, std::int64_t n) {
    Key* first = self().raw(keys);
    thrust::sort(self().policy(), first, first + n);
  }
  /// Stable.
  template <class Key, class Value>
  void sort_by_key(Pointer<Key> keys, Pointer<Value> values, std::int64_t n) {
    Key* first = self().raw(keys);
    thrust::stable_sort_by_key(self().policy(), first, first + n, self().raw(values));
  }
  /// Exclusive sums in place. The last value is read but has no effect.
  template <class T>
  void scan(Pointer<T> values, std::int64_t n) {
    T* first = self().raw(values);
    thrust::exclusive_scan(self().policy(), first, first + n, first);
  }
  /// Of equal neighbours keeps the first; returns how many values are left.
  template <class T>
  std::int64_t unique(Pointer<T> values, std::int64_t n) {
    T* first = self().raw(values);
    return thrust::unique(self().policy(), first, first + n) - first;
  }

 private:
  Backend& self() { return static_cast<Backend&>(*this); }
};

}  // namespace qdem::device
