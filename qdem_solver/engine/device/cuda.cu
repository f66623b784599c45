#include <algorithm>

#include "qdem_solver/engine/device/cuda_backend.cuh"
#include "qdem_solver/engine/device/march.hpp"

namespace qdem {
namespace {

struct Copy {
  device::Pointer<const double> from;
  device::Pointer<double> to;
  HOUSE_HOST_DEVICE void operator()(const device::Access& at, std::int64_t i) const { at(to)[i] = at(from)[i]; }
};

void require_cuda() {
  const std::string reason = why_no_cuda();
  if (!reason.empty()) {
    throw proto::Error(proto::ExitCode::unavailable, "the CUDA engine cannot be used (" + reason + ")", "",
                       "set [qdem] engine = \"cpu\"");
  }
}

}  // namespace

std::string why_no_cuda() {
  int n_devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&n_devices);
  if (status != cudaSuccess) return std::string("no CUDA device: ") + cudaGetErrorString(status);
  return n_devices > 0 ? "" : "no CUDA device";
}

std::unique_ptr<Stepper> make_cuda_stepper(const Model& model) {
  require_cuda();
  return std::make_unique<device::March<device::CudaBackend>>(model);
}

DeviceRates measure_cuda_device() {
  require_cuda();
  cudaDeviceProp properties{};
  device::check_cuda(cudaGetDeviceProperties(&properties, 0));
  constexpr std::int64_t n = std::int64_t{1} << 25;  // 256 MB each way: far more than any cache
  device::CudaBackend backend;
  const device::Buffer<device::CudaBackend, double> from(n);
  device::Buffer<device::CudaBackend, double> to(n);
  cudaEvent_t begin{}, end{};
  device::check_cuda(cudaEventCreate(&begin));
  device::check_cuda(cudaEventCreate(&end));
  float best_ms = 1e30f;
  for (int trial = 0; trial < 10; ++trial) {
    float ms = 0;
    device::check_cuda(cudaEventRecord(begin, cudaStreamPerThread));
    backend.run(Copy{from.data(), to.data()}, n);
    device::check_cuda(cudaEventRecord(end, cudaStreamPerThread));
    device::check_cuda(cudaEventSynchronize(end));
    device::check_cuda(cudaEventElapsedTime(&ms, begin, end));
    best_ms = std::min(best_ms, ms);
  }
  cudaEventDestroy(begin), cudaEventDestroy(end);
  return {properties.name, 2.0 * static_cast<double>(n) * sizeof(double) / (1e-3 * best_ms)};
}

}  // namespace qdem
