// A view of contiguous values that host and device code can share.
#pragma once

#include <cstddef>
#include <vector>

#if defined(__CUDACC__)
#define HOUSE_HOST_DEVICE __host__ __device__
#else
#define HOUSE_HOST_DEVICE
#endif

namespace proto {

/// Non-owning view of `size` values. The owner must outlive it and keep its address.
template <class T>
class Span {
 public:
  Span() = default;
  HOUSE_HOST_DEVICE Span(T* data, std::size_t size) : data_(data), size_(size) {}
  template <class U>
  Span(std::vector<U>& values) : data_(values.data()), size_(values.size()) {}
  template <class U>
  Span(const std::vector<U>& values) : data_(values.data()), size_(values.size()) {}

  HOUSE_HOST_DEVICE T& operator[](std::size_t i) const { return data_[i]; }
  HOUSE_HOST_DEVICE T* data() const { return data_; }
  HOUSE_HOST_DEVICE std::size_t size() const { return size_; }
  HOUSE_HOST_DEVICE T* begin() const { return data_; }
  HOUSE_HOST_DEVICE T* end() const { return data_ + size_; }
  HOUSE_HOST_DEVICE Span sub(std::size_t first, std::size_t count) const { return {data_ + first, count}; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace proto
