#include "qdem_solver/engine/stepper.hpp"

#include <algorithm>
#include <sstream>

#include "proto/error.hpp"

namespace qdem {

const char* engine_name(EngineKind kind) {
  switch (kind) {
    case EngineKind::cuda:
      return "cuda";
    case EngineKind::check:
      return "check";
    default:
      return "cpu";
  }
}

std::string why_no_engine(EngineKind kind) {
  return kind == EngineKind::cuda ? why_no_cuda() : "";
}

std::string unknown_to_engine(EngineKind kind, const Model& model) {
  if (kind == EngineKind::cpu) return "";
  if (model.contact.shape != ContactShape::facet) return "contact spheres";
  if (!model.lining.is_rigid()) return "a pad under the sleeper";
  const auto gives_way = [](const Plane& plane) { return !plane.bearing.is_rigid(); };
  if (std::any_of(model.planes.begin(), model.planes.end(), gives_way)) return "ground that gives way";
  const auto is_ground = [](const Body& body) { return body.kind == BodyKind::ground; };
  if (!model.boundary.empty() || std::any_of(model.bodies.begin(), model.bodies.end(), is_ground)) {
    return "a subgrade of elements";
  }
  return model.loads.empty() ? "" : "loads on patches";
}

std::unique_ptr<Stepper> make_stepper(const Model& model, const EngineOptions& options) {
  const std::string unknown = unknown_to_engine(options.kind, model);
  if (!unknown.empty()) {
    throw proto::Error(proto::ExitCode::config, "the device engine does not know " + unknown,
                       std::string("engine \"") + engine_name(options.kind) + "\"", "take the engine \"cpu\"");
  }
  switch (options.kind) {
    case EngineKind::cuda:
      return make_cuda_stepper(model);
    case EngineKind::check:
      return make_check_stepper(model, options.check_seed);
    default:
      return nullptr;
  }
}

void report_blow_up(const Model& model, const State& state) {
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    for (int node = 0; node < model.shape(static_cast<int>(body)).n_nodes(); ++node) {
      const auto b = static_cast<int>(body);
      if (state.position(model, b, node).allFinite() && state.velocity(model, b, node).allFinite()) continue;
      std::ostringstream problem, where;
      problem << "the motion is no longer finite";
      where << "step " << state.step << ", t = " << state.time << " s, body " << body << " '" << model.bodies[body].name
            << "', node " << node;
      throw proto::Error(proto::ExitCode::numerics, problem.str(), where.str(),
                         "lower [qdem] step_safety, or look for overlapping bodies at the start");
    }
  }
  throw proto::Error(proto::ExitCode::numerics, "the motion overflows", "step " + std::to_string(state.step),
                     "lower [qdem] step_safety");
}

}  // namespace qdem
