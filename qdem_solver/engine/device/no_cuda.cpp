// What stands for the CUDA engine in a build without it.
#include "proto/error.hpp"
#include "qdem_solver/engine/stepper.hpp"

namespace qdem {
namespace {

[[noreturn]] void refuse() {
  throw proto::Error(proto::ExitCode::unavailable, "the CUDA engine cannot be used (" + why_no_cuda() + ")", "",
                     "build with: cmake --preset cuda, or set [qdem] engine = \"cpu\"");
}

}  // namespace

std::string why_no_cuda() {
  return "this program was built without it";
}

std::unique_ptr<Stepper> make_cuda_stepper(const Model&) {
  refuse();
}

DeviceRates measure_cuda_device() {
  refuse();
}

}  // namespace qdem
