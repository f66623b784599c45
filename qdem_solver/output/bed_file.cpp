#include "qdem_solver/output/bed_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "proto/error.hpp"
#include "qdem_solver/output/exchange.hpp"
#include "qdem_solver/output/hdf5_store.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;
using Integers = std::vector<long long>;
using Reals = std::vector<double>;

void append(Reals& values, const Vector3d& v) {
  values.insert(values.end(), {v[0], v[1], v[2]});
}
Vector3d triple(const Reals& values, std::size_t at) {
  return {values.at(at), values.at(at + 1), values.at(at + 2)};
}

void put_templates(Hdf5Store& file, const Model& model) {
  std::vector<std::string> names;
  for (std::size_t t = 0; t < model.templates.size(); ++t) {
    const Template& shape = model.templates[t];
    const std::string group = "templates/" + std::to_string(t);
    Reals nodes;
    for (const Vector3d& x : shape.nodes) append(nodes, x);
    Integers tets;
    for (const auto& tet : shape.tets) tets.insert(tets.end(), tet.begin(), tet.end());
    file.put(group + "/nodes", nodes, "m");
    file.put(group + "/tets", tets);
    names.push_back(shape.name);
  }
  file.put("templates/names", names);
}

void take_templates(const Hdf5Store& file, Model& model) {
  const auto names = file.lines("templates/names");
  for (std::size_t t = 0; t < names.size(); ++t) {
    const std::string group = "templates/" + std::to_string(t);
    const Reals nodes = file.reals(group + "/nodes");
    const Integers tets = file.integers(group + "/tets");
    std::vector<Vector3d> places;
    for (std::size_t i = 0; i + 2 < nodes.size(); i += 3) places.push_back(triple(nodes, i));
    std::vector<std::array<int, 4>> elements;
    for (std::size_t e = 0; e + 3 < tets.size(); e += 4) {
      elements.push_back({int(tets[e]), int(tets[e + 1]), int(tets[e + 2]), int(tets[e + 3])});
    }
    model.templates.push_back(make_template(names[t], std::move(places), std::move(elements)));
  }
}

void put_bodies(Hdf5Store& file, const Model& model) {
  Integers ids;
  Reals scales;
  std::vector<std::string> names;
  for (const Body& body : model.bodies) {
    ids.insert(ids.end(), {static_cast<long long>(body.kind), body.template_id, body.material_id});
    scales.push_back(body.scale);
    names.push_back(body.name);
  }
  file.put("bodies/kind_template_material", ids);
  file.put("bodies/scale", scales, "1");
  file.put("bodies/names", names);
  Integers fixities;
  for (const Fixity& f : model.fixities) fixities.insert(fixities.end(), {f.body, f.node, f.mask});
  file.put("bodies/fixities", fixities);
}

void take_bodies(const Hdf5Store& file, Model& model) {
  const Integers ids = file.integers("bodies/kind_template_material");
  const Reals scales = file.reals("bodies/scale");
  const auto names = file.lines("bodies/names");
  for (std::size_t b = 0; b < scales.size(); ++b) {
    Body body;
    body.kind = static_cast<BodyKind>(ids.at(3 * b));
    body.template_id = static_cast<int>(ids.at(3 * b + 1)), body.material_id = static_cast<int>(ids.at(3 * b + 2));
    body.scale = scales[b], body.name = names.at(b);
    model.bodies.push_back(body);
  }
  const Integers f = file.integers("bodies/fixities");
  for (std::size_t i = 0; i + 2 < f.size(); i += 3) {
    model.fixities.push_back({int(f[i]), int(f[i + 1]), static_cast<unsigned>(f[i + 2])});
  }
}

void put_planes(Hdf5Store& file, const Model& model) {
  Reals values;
  Integers touches;
  std::vector<std::string> names;
  for (const Plane& plane : model.planes) {
    append(values, plane.point), append(values, plane.normal), append(values, plane.velocity);
    values.push_back(plane.friction);
    touches.insert(touches.end(), {plane.touches_stones, plane.touches_sleeper});
    names.push_back(plane.name);
  }
  file.put("planes/point_normal_velocity_friction", values, "m, 1, m/s, 1");
  file.put("planes/touches_stones_sleeper", touches);
  file.put("planes/names", names);
}

void take_planes(const Hdf5Store& file, Model& model) {
  const Reals values = file.reals("planes/point_normal_velocity_friction");
  const Integers touches = file.integers("planes/touches_stones_sleeper");
  const auto names = file.lines("planes/names");
  for (std::size_t p = 0; p < names.size(); ++p) {
    model.planes.push_back({names[p], triple(values, 10 * p), triple(values, 10 * p + 3), triple(values, 10 * p + 6),
                            values.at(10 * p + 9), touches.at(2 * p) != 0, touches.at(2 * p + 1) != 0});
  }
}

void put_boundary(Hdf5Store& file, const Model& model) {
  if (model.boundary.empty()) return;
  Integers particles;
  Reals values;
  for (const BoundaryParticle& p : model.boundary) {
    particles.insert(particles.end(), {p.body, p.node});
    append(values, p.rest), append(values, p.stiffness), append(values, p.damping);
  }
  file.put("boundary/body_node", particles);
  file.put("boundary/rest_stiffness_damping", values, "m, N/m, N s/m");
}

void take_boundary(const Hdf5Store& file, Model& model) {
  const Integers particles = file.integers("boundary/body_node");
  const Reals values = file.reals("boundary/rest_stiffness_damping");
  for (std::size_t p = 0; 2 * p + 1 < particles.size(); ++p) {
    model.boundary.push_back({int(particles[2 * p]), int(particles[2 * p + 1]), triple(values, 9 * p),
                              triple(values, 9 * p + 3), triple(values, 9 * p + 6)});
  }
}

/// What exchange() names, into a bed file or out of it.
class StoreArchive : public proto::StateArchive {
 public:
  explicit StoreArchive(Hdf5Store& to) : to_(&to) {}
  explicit StoreArchive(const Hdf5Store& from) : from_(&from) {}
  using StateArchive::operator();
  bool restoring() const override { return from_ != nullptr; }
  void operator()(const std::string& name, Reals& values) override {
    if (to_ != nullptr) return to_->put(name, values);
    values = from_->reals(name);
  }
  void operator()(const std::string& name, std::vector<std::int64_t>& values) override {
    if (to_ != nullptr) return to_->put(name, Integers(values.begin(), values.end()));
    const Integers read = from_->integers(name);
    values.assign(read.begin(), read.end());
  }

 private:
  [[noreturn]] void refuse(const std::string& name, const std::string& problem) const override {
    throw proto::Error(proto::ExitCode::bad_data, "the bed does not fit: " + problem, name);
  }
  Hdf5Store* to_ = nullptr;
  const Hdf5Store* from_ = nullptr;
};

void put_state(Hdf5Store& file, State state) {
  file.put("state/x", state.x, "m");
  file.put("state/v", state.v, "m/s");
  file.put("state/a", state.a, "m/s2");
  StoreArchive archive(file);
  exchange(archive, "state/contact/", state.contact);
}

void take_state(const Hdf5Store& file, const Model& model, State& state) {
  state.x = file.reals("state/x"), state.v = file.reals("state/v"), state.a = file.reals("state/a");
  ContactState& contact = state.contact;
  StoreArchive archive(file);
  exchange(archive, "state/contact/", contact);
  const auto n = static_cast<std::size_t>(model.n_values);
  if (state.x.size() != n || state.v.size() != n || state.a.size() != n || contact.slip.size() != contact.keys.size() ||
      contact.travel.size() != model.bodies.size() || contact.triangle_offsets.size() != contact.keys.size() + 1) {
    throw proto::Error(proto::ExitCode::bad_data, "the arrays of the bed do not fit each other");
  }
}

/// The figures of a report by name.
template <class Report>
auto named_values(Report& r) {
  return std::vector<std::pair<const char*, decltype(&r.d50)>>{{"porosity_under_sleeper", &r.porosity_under_sleeper},
                                                               {"porosity_layer", &r.porosity_layer},
                                                               {"coordination_number", &r.coordination_number},
                                                               {"largest_penetration_m", &r.largest_penetration},
                                                               {"unbalanced_force_ratio", &r.unbalanced_force_ratio},
                                                               {"kinetic_energy_j", &r.kinetic_energy},
                                                               {"d50_m", &r.d50},
                                                               {"elements_per_stone", &r.elements_per_stone},
                                                               {"sleeper_settlement_m", &r.sleeper_settlement},
                                                               {"stiffness_n_per_m", &r.stiffness},
                                                               {"sleeper_shift_m", &r.sleeper_shift},
                                                               {"sleeper_tilt_rad", &r.sleeper_tilt},
                                                               {"build_wall_s", &r.build_wall_s}};
}

void put_report(Hdf5Store& file, const BedReport& r) {
  file.put("report/counts", Integers{r.stones, r.elements, r.seed});
  Reals values;
  std::vector<std::string> names;
  for (const auto& [name, value] : named_values(r)) names.emplace_back(name), values.push_back(*value);
  file.put("report/values", values);
  file.put("report/value_names", names);
  file.put("report/notes", r.notes);
  file.put("report/hash", std::vector<std::string>{r.hash});
}

BedReport take_report(const Hdf5Store& file) {
  const Integers counts = file.integers("report/counts");
  const Reals values = file.reals("report/values");
  BedReport r;
  r.stones = counts.at(0), r.elements = counts.at(1), r.seed = counts.at(2);
  std::size_t i = 0;
  for (const auto& [name, value] : named_values(r)) *value = values.at(i++);
  r.notes = file.lines("report/notes");
  r.hash = file.lines("report/hash").at(0);
  return r;
}

Bed take_bed(const Hdf5Store& file, const BedPhysics& physics) {
  if (file.integers("format").at(0) != bed_file_format) {
    throw proto::Error(proto::ExitCode::bad_data, "a bed file of another format");
  }
  Bed bed;
  bed.model.materials = physics.materials();
  bed.model.contact = physics.contact;
  bed.model.gravity = physics.gravity, bed.model.lining = physics.lining;
  bed.model.pad_body = 0;
  take_templates(file, bed.model);
  take_bodies(file, bed.model);
  take_planes(file, bed.model);
  for (Plane& plane : bed.model.planes) {
    if (plane.name == "ground") plane.bearing = physics.ground;
  }
  if (physics.subgrade) {
    take_boundary(file, bed.model);
    bed.model.ground_friction = physics.ground_friction;
  }
  make_batches(bed.model);
  take_state(file, bed.model, bed.state);
  bed.report = take_report(file);
  return bed;
}

}  // namespace

void write_bed_file(const std::string& path, const Bed& bed) {
  const std::string draft = path + "." + std::to_string(::getpid());
  try {
    Hdf5Store file = Hdf5Store::create(draft);
    file.put("format", Integers{bed_file_format});
    put_templates(file, bed.model);
    put_bodies(file, bed.model);
    put_planes(file, bed.model);
    put_boundary(file, bed.model);
    put_state(file, bed.state);
    put_report(file, bed.report);
    file.close();
  } catch (const proto::Error&) {
    std::remove(draft.c_str());
    throw;
  }
  std::error_code error;
  std::filesystem::rename(draft, path, error);
  if (!error) return;
  std::remove(draft.c_str());
  throw proto::Error(proto::ExitCode::io_error, "the bed file cannot be renamed: " + error.message(), path);
}

Bed read_bed_file(const std::string& path, const BedPhysics& physics) {
  if (!std::filesystem::exists(path)) throw proto::Error(proto::ExitCode::missing_input, "no bed file", path);
  const Hdf5Store file = Hdf5Store::open(path);
  std::string why;
  try {
    return take_bed(file, physics);
  } catch (const std::out_of_range&) {
    why = "it is not whole";
  } catch (const proto::Error& error) {
    why = error.what();
  }
  throw proto::Error(proto::ExitCode::bad_data, "the bed file cannot be used: " + why, path,
                     "delete it, then the bed is built anew");
}

}  // namespace qdem
