#include "qdem_solver/engine/device/check_backend.hpp"
#include "qdem_solver/engine/device/march.hpp"

namespace qdem {

std::unique_ptr<Stepper> make_check_stepper(const Model& model, std::uint64_t seed) {
  return std::make_unique<device::March<device::CheckBackend>>(model, seed);
}

}  // namespace qdem
