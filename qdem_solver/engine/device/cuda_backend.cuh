// The CUDA device. Included by .cu files only.
#pragma once

#include <cuda_runtime.h>

#include <string>
#include <type_traits>
#include <vector>

#include "proto/error.hpp"
#include "qdem_solver/engine/device/algorithms.hpp"
#include "qdem_solver/engine/device/records.hpp"

namespace qdem::device {

inline void check_cuda(cudaError_t status) {
  if (status == cudaSuccess) return;
  throw proto::Error(proto::ExitCode::os_error,
                     std::string("the CUDA device failed (") + cudaGetErrorString(status) + ")", "",
                     "look at nvidia-smi, or set [qdem] engine = \"cpu\"");
}

/// One thread of a kernel: the only place on the device where an Access is made.
struct CudaThread {
  template <class Kernel>
  __device__ static void run(const Kernel& kernel, std::int64_t n_items) {
    const std::int64_t item = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (item < n_items) kernel(Access(), item);
  }
};

template <class Kernel>
__global__ void __launch_bounds__(block_size) run_kernel(const Kernel kernel, std::int64_t n_items) {
  CudaThread::run(kernel, n_items);
}

/// Everything is queued on one stream, that of the calling thread; copies wait for it.
class CudaBackend : public Algorithms<CudaBackend> {
 public:
  template <class T>
  static Pointer<T> allocate(std::size_t n) {
    T* memory = nullptr;
    if (n > 0) check_cuda(cudaMalloc(&memory, n * sizeof(T)));
    return Access::pointer(memory);
  }
  template <class T>
  static void release(Pointer<T> memory) {
    cudaFree(raw(memory));
  }
  template <class T>
  static void forget(Pointer<T>, std::size_t) {}
  template <class T>
  static void to_device(Pointer<T> to, const T* from, std::size_t n) {
    copy(raw(to), from, n * sizeof(T), cudaMemcpyHostToDevice);
  }
  template <class T>
  static void to_host(T* to, Pointer<const T> from, std::size_t n) {
    copy(to, raw(from), n * sizeof(T), cudaMemcpyDeviceToHost);
  }
  template <class T>
  static void between(Pointer<T> to, Pointer<const T> from, std::size_t n) {
    copy(raw(to), raw(from), n * sizeof(T), cudaMemcpyDeviceToDevice);
  }
  static void spoil(std::vector<double>&) {}

  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t n_items) {
    static_assert(std::is_trivially_copyable_v<Kernel>);
    if (n_items == 0) return;
    const auto n_blocks = static_cast<unsigned>((n_items + block_size - 1) / block_size);
    run_kernel<<<n_blocks, block_size, 0, stream()>>>(kernel, n_items);
    check_cuda(cudaGetLastError());
  }

  /// `n` times the launches of `step`, recorded once as a graph: what the host does for a step is one call.
  template <class Step>
  void repeat(std::int64_t n, const Step& step) {
    if (n == 0) return;
    cudaGraph_t graph = nullptr;
    cudaGraphExec_t recorded = nullptr;
    check_cuda(cudaStreamBeginCapture(stream(), cudaStreamCaptureModeThreadLocal));
    step();
    check_cuda(cudaStreamEndCapture(stream(), &graph));
    check_cuda(cudaGraphInstantiateWithFlags(&recorded, graph, 0));
    for (std::int64_t i = 0; i < n; ++i) check_cuda(cudaGraphLaunch(recorded, stream()));
    check_cuda(cudaStreamSynchronize(stream()));
    cudaGraphExecDestroy(recorded);
    cudaGraphDestroy(graph);
  }

 private:
  friend class Algorithms<CudaBackend>;

  static auto policy() { return thrust::cuda::par.on(stream()); }
  template <class T>
  static T* raw(Pointer<T> pointer) {
    return Access()(pointer);
  }

  static cudaStream_t stream() { return cudaStreamPerThread; }
  static void copy(void* to, const void* from, std::size_t n_bytes, cudaMemcpyKind kind) {
    if (n_bytes == 0) return;
    check_cuda(cudaMemcpyAsync(to, from, n_bytes, kind, stream()));
    check_cuda(cudaStreamSynchronize(stream()));
  }
};

}  // namespace qdem::device
