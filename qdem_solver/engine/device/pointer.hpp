// Addresses in device memory. Host code may hold, copy and move them, and nothing else.
#pragma once

#include <cstdint>
#include <type_traits>

#include "proto/span.hpp"

namespace qdem::device {

class Access;

/// Address of a `T` in the memory of a device. It has no dereference: only the Access that a backend hands to a kernel
/// turns it into a plain pointer, so that host code that looks into device memory does not compile.
template <class T>
class Pointer {
 public:
  Pointer() = default;
  template <class U, class = std::enable_if_t<std::is_convertible_v<U*, T*>>>
  HOUSE_HOST_DEVICE Pointer(Pointer<U> other) : address_(other.address_) {}

  HOUSE_HOST_DEVICE Pointer operator+(std::int64_t n) const { return Pointer(address_ + n); }

 private:
  friend class Access;
  template <class>
  friend class Pointer;
  HOUSE_HOST_DEVICE explicit Pointer(T* address) : address_(address) {}

  T* address_ = nullptr;
};

/// The right to look into device memory. Kernels get one with every item; host code cannot make one.
class Access {
 public:
  template <class T>
  HOUSE_HOST_DEVICE T* operator()(Pointer<T> pointer) const {
    return pointer.address_;
  }

 private:
  friend class CheckBackend;
  friend class CudaBackend;
  friend struct CudaThread;  ///< one thread of a running kernel
  HOUSE_HOST_DEVICE Access() {}

  template <class T>
  HOUSE_HOST_DEVICE static Pointer<T> pointer(T* address) {
    return Pointer<T>(address);
  }
};

}  // namespace qdem::device
