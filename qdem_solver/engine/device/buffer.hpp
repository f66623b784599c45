// Arrays in device memory and their owners.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include "qdem_solver/engine/device/pointer.hpp"

namespace qdem::device {

/// Owns `size()` values in the memory of a backend's device. New memory holds no meaningful values: the checking
/// backend fills it with NaN. Moved, not copied; copy() is explicit since it costs.
///
/// Backend (CheckBackend, CudaBackend) has static allocate(bytes), release(), to_device(), to_host(), between().
template <class Backend, class T>
class Buffer {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  Buffer() = default;
  explicit Buffer(std::size_t size) { resize(size); }
  explicit Buffer(const std::vector<T>& values) { put(values.data(), values.size()); }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer() { Backend::release(data_); }

  std::size_t size() const { return size_; }
  Pointer<T> data() { return data_; }
  Pointer<const T> data() const { return data_; }

  /// Room for `size` values; the old ones are lost, also when the size stays.
  void resize(std::size_t size) {
    if (size != size_) {
      Backend::release(data_);
      data_ = {};
      data_ = Backend::template allocate<T>(size);
      size_ = size;
    }
    Backend::forget(data_, size_);
  }

  /// Takes the values from the host; the size follows.
  void put(const T* values, std::size_t size) {
    resize(size);
    Backend::to_device(data_, values, size_);
  }
  void put(const std::vector<T>& values) { put(values.data(), values.size()); }

  /// The values, in host memory of size() values.
  void get(T* values) const { Backend::to_host(values, data(), size_); }
  std::vector<T> get() const {
    std::vector<T> values(size_);
    get(values.data());
    return values;
  }
  T value(std::size_t i) const {
    T value;
    Backend::to_host(&value, data() + static_cast<std::int64_t>(i), 1);
    return value;
  }

  Buffer copy() const {
    Buffer result(size_);
    Backend::between(result.data_, data(), size_);
    return result;
  }

 private:
  void swap(Buffer& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

  Pointer<T> data_;
  std::size_t size_ = 0;
};

}  // namespace qdem::device
