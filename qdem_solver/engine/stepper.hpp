// What an engine on a device does for Engine: the steps.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/engine/engine.hpp"

namespace qdem {

/// Integrates host states in the memory of a device: takes a State there, makes the steps without the host, brings it
/// back. A State that comes back carries State::resident, and need not be taken there again; copies of it share that
/// memory until one of them is stepped on. Gravity, damping, inertia, loads and the planes' velocities are read from
/// the model at every call.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// See Engine::prepare(). What the device holds of `state` is dropped.
  virtual void prepare(State& state) = 0;
  /// See Engine::advance(). drive: nullptr without pads.
  virtual PadSums advance(State& state, double dt, std::int64_t n_steps, const PadDrive* drive) = 0;
  /// Pad values of the positions that count as undisplaced [m].
  virtual void set_pad_reference(std::vector<double> values) = 0;
  /// Hands the contact forces of the last step, which was one of `state`, to `stage`.
  virtual void show_contacts(const State& state, ContactStage& stage) const = 0;
};

/// The one that EngineOptions asks for; nullptr for the CPU engine, which makes its steps itself. Throws proto::Error
/// (config) for a model with what unknown_to_engine() names.
std::unique_ptr<Stepper> make_stepper(const Model& model, const EngineOptions& options);

/// The kernels of the device engine, run by the host in a random order over separate copies of all data (`seed` 0: in
/// ascending order): slow, and meant for checking them.
std::unique_ptr<Stepper> make_check_stepper(const Model& model, std::uint64_t seed);

/// The CUDA engine. Throws proto::Error (unavailable) where why_no_cuda() has a reason.
std::unique_ptr<Stepper> make_cuda_stepper(const Model& model);

/// Why the CUDA engine cannot be used here: not built in, no device. Empty: it can.
std::string why_no_cuda();

/// A CUDA device.
struct DeviceRates {
  std::string name;
  double copy_rate = 0.0;  ///< bytes a second of a plain copy kernel, read and written bytes both counted
};
/// Throws as make_cuda_stepper().
DeviceRates measure_cuda_device();

/// Throws proto::Error (numerics) naming step, time, body and node whose motion is not finite.
[[noreturn]] void report_blow_up(const Model& model, const State& state);

}  // namespace qdem
