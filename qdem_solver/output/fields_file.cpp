#include "qdem_solver/output/fields_file.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "qdem_solver/engine/stress.hpp"

namespace qdem {
namespace {

int n_bodies(const Model& model) {
  return static_cast<int>(model.bodies.size());
}

/// Values of an array laid out like State::x in the order of the points: body, node, component.
std::vector<double> in_point_order(const Model& model, const std::vector<double>& values) {
  std::vector<double> result;
  for (int body = 0; body < n_bodies(model); ++body) {
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      const Eigen::Vector3d value = State::gather(model, values, body, node);
      result.insert(result.end(), value.data(), value.data() + 3);
    }
  }
  return result;
}

proto::OutputMesh mesh_of(const Model& model, const std::vector<double>& points) {
  std::vector<std::int64_t> connectivity;
  std::int64_t first = 0;
  for (int body = 0; body < n_bodies(model); ++body) {
    for (const auto& tet : model.shape(body).tets) {
      for (const int node : tet) connectivity.push_back(first + node);
    }
    first += model.shape(body).n_nodes();
  }
  return proto::OutputMesh::of_one_type(points, std::move(connectivity), proto::CellType::tetrahedron);
}

/// One value per cell, the same in all cells of a body.
template <class ValueOf>
std::vector<float> per_body(const Model& model, ValueOf value_of) {
  std::vector<float> result;
  for (int body = 0; body < n_bodies(model); ++body) {
    result.insert(result.end(), model.shape(body).n_tets(), static_cast<float>(value_of(body)));
  }
  return result;
}

bool has_kind(const Model& model, BodyKind kind) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) { return body.kind == kind; });
}

proto::FieldSeriesOptions options_of(const Model& model, const std::vector<double>& points,
                                     const proto::Attributes& attributes, bool has_ledger) {
  using proto::Location;
  proto::FieldSeriesOptions options;
  options.mesh = mesh_of(model, points);
  options.fields = {
      {"displacement", "m", "from the positions at the start", Location::point, 3},
      {"velocity", "m/s", "of the particles", Location::point, 3},
      {"von_mises_stress", "Pa", "of the Cauchy stress", Location::cell, 1},
      {"mean_stress", "Pa", "a third of the trace of the Cauchy stress, tension positive", Location::cell, 1},
  };
  options.static_fields = {
      {{"body", "1", "number of the body", Location::cell, 1}, per_body(model, [](int body) { return body; })},
      {{"sleeper", "1", "1 in the sleeper, 0 in stones", Location::cell, 1},
       per_body(model, [&](int body) { return model.bodies[body].kind == BodyKind::sleeper; })},
  };
  if (has_kind(model, BodyKind::ground)) {
    options.static_fields.push_back(
        {{"ground", "1", "1 in the layer of the ground", Location::cell, 1},
         per_body(model, [&](int body) { return model.bodies[body].kind == BodyKind::ground; })});
  }
  options.histories = {{"time", "s", "simulated time", {}},
                       {"kinetic_energy", "J", "of all particles", {}},
                       {"strain_energy", "J", "of all elements", {}},
                       {"contact_energy", "J", "of the contact springs", {}},
                       {"gravity_energy", "J", "of all particles, from z = 0", {}}};
  if (has_ledger) {
    options.histories.insert(options.histories.end(),
                             {{"work_of_loads", "J", "of pads and loads on the bodies, since the start", {}},
                              {"viscous_dissipation", "J", "in the elements, since the start", {}},
                              {"contact_dissipation", "J", "of the contacts' dashpots, since the start", {}},
                              {"friction_dissipation", "J", "of the contacts' sliders, since the start", {}},
                              {"energy_residual", "J", "change of the energies plus dissipation minus work", {}},
                              {"energy_residual_relative", "1", "the residual over the energy that was moved", {}}});
  }
  if (!model.boundary.empty()) {
    options.histories.push_back({"boundary_energy", "J", "of the springs where the meshed ground ends", {}});
    if (has_ledger) {
      options.histories.push_back({"radiated", "J", "into the dashpots there, since the start", {}});
    }
  }
  options.histories.push_back({"touching", "1", "contacts that carry a force", {}});
  options.attributes = attributes;
  return options;
}

}  // namespace

FieldsFile::FieldsFile(const Model& model, std::vector<double> reference, proto::FieldSeriesFile file, bool has_ledger)
    : model_(model), reference_(std::move(reference)), file_(std::move(file)), has_ledger_(has_ledger) {}

FieldsFile::FieldsFile(const std::string& path, const Model& model, const State& reference,
                       const proto::Attributes& attributes, bool has_ledger)
    : model_(model),
      reference_(in_point_order(model, reference.x)),
      file_(proto::FieldSeriesFile::create(path, options_of(model, reference_, attributes, has_ledger))),
      has_ledger_(has_ledger) {}

FieldsFile FieldsFile::resume(const std::string& path, const Model& model, const State& reference,
                              const proto::Attributes& attributes, std::uint64_t n_steps, bool has_ledger) {
  auto points = in_point_order(model, reference.x);
  auto file = proto::FieldSeriesFile::resume(path, n_steps, n_steps, options_of(model, points, attributes, has_ledger));
  return {model, std::move(points), std::move(file), has_ledger};
}

void FieldsFile::put_stresses(const State& state) {
  std::vector<double> von_mises, mean;
  for (int body = 0; body < n_bodies(model_); ++body) {
    for (int e = 0; e < model_.shape(body).n_tets(); ++e) {
      const Eigen::Matrix3d stress = element_stress(model_, state, body, e);
      mean.push_back(stress.trace() / 3);
      von_mises.push_back(std::sqrt(1.5) * (stress - mean.back() * Eigen::Matrix3d::Identity()).norm());
    }
  }
  file_.put("von_mises_stress", von_mises);
  file_.put("mean_stress", mean);
}

void FieldsFile::put_energies(const EnergyBalance& balance) {
  file_.put_history("kinetic_energy", balance.stored.kinetic);
  file_.put_history("strain_energy", balance.stored.strain);
  file_.put_history("contact_energy", balance.stored.contact);
  file_.put_history("gravity_energy", balance.stored.gravity);
  if (!model_.boundary.empty()) {
    file_.put_history("boundary_energy", balance.stored.boundary);
    if (has_ledger_) file_.put_history("radiated", balance.radiated);
  }
  if (!has_ledger_) return;
  file_.put_history("work_of_loads", balance.work);
  file_.put_history("viscous_dissipation", balance.viscous);
  file_.put_history("contact_dissipation", balance.contact_dashpots);
  file_.put_history("friction_dissipation", balance.friction);
  file_.put_history("energy_residual", balance.residual());
  file_.put_history("energy_residual_relative", balance.relative());
}

void FieldsFile::write(double time, const State& state, const Engine& engine, const EnergyBalance& balance) {
  std::vector<double> displacement = in_point_order(model_, state.x);
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] -= reference_[i];
  const ContactReport contacts = engine.contacts().report(state);
  file_.put_history("time", time);
  put_energies(balance);
  file_.put_history("touching", static_cast<double>(contacts.live));
  file_.end_history_row();
  file_.begin_step(time);
  file_.put("displacement", displacement);
  file_.put("velocity", in_point_order(model_, state.v));
  put_stresses(state);
  file_.end_step();
}

void FieldsFile::close() {
  file_.close();
}

}  // namespace qdem
