#include "qdem_solver/engine/engine.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "qdem_solver/engine/cpu/engine_data.hpp"
#include "qdem_solver/engine/relaxation.hpp"

namespace qdem {

using cpu::Task;
using cpu::TaskKind;
using proto::Span;

Engine::Data::Data(const Model& the_model, EngineOptions the_options)
    : model(the_model),
      options(std::move(the_options)),
      n_threads(options.threads > 0 ? options.threads : omp_get_max_threads()),
      kernels(cpu::kernels()),
      tasks(cpu::make_tasks(model)),
      inverse_mass(cpu::inverse_masses(model)),
      free_motions(cpu::free_motions(model)),
      force(model.n_values),
      moves(model.bodies.size(), 0.0),
      slots(tasks.n_slot_values),
      records(n_threads, cpu::AlignedValues(8 * tasks.largest_block)),
      contact(model),
      pads(model),
      loads(model),
      boundary(model),
      device(make_stepper(model, options)) {}

Engine::Engine(const Model& model, EngineOptions options) : data_(std::make_unique<Data>(model, std::move(options))) {}
Engine::~Engine() = default;

const ContactStage& Engine::contacts() const {
  return data_->contact;
}

void Engine::set_pad_reference(const std::vector<double>& reference) {
  data_->pad_reference = data_->pad_values(reference);
  if (data_->device) data_->device->set_pad_reference(data_->pad_reference);
}

void Engine::Data::drift(State& state, double dt) {
  const auto n_batches = static_cast<std::int64_t>(model.batches.size());
  bool finite = true;
#pragma omp parallel for schedule(static) num_threads(n_threads) reduction(&& : finite)
  for (std::int64_t b = 0; b < n_batches; ++b) {
    const Batch& batch = model.batches[b];
    const int n = 3 * model.templates[batch.template_id].n_nodes();
    const auto at = batch.offset;
    const auto moved = kernels.drift({dt, batch.lanes, n, &state.x[at], &state.v[at], &state.a[at]});
    finite = finite && std::isfinite(moved.sum);
    for (int lane = 0; lane < batch.lanes; ++lane) {
      // sqrt(3): of a value to that of a node
      if (batch.bodies[lane] >= 0) moves[batch.bodies[lane]] = std::sqrt(3.0) * moved.largest_move[lane];
    }
  }
  if (!finite) report_blow_up(model, state);
}

void Engine::Data::kick(State& state, const Batch& batch, int first, int last, double dt) {
  const std::int64_t at = batch.offset + std::int64_t{3} * first * batch.lanes;
  const Eigen::Vector3d gravity = model.gravity_on(batch.bodies[0]);
  kernels.kick({dt,
                {gravity[0], gravity[1], gravity[2]},
                relaxing() ? 0.0 : model.local_damping,
                model.drag_per_s,
                batch.lanes,
                last - first,
                &force[at],
                &inverse_mass[at],
                &state.v[at],
                &state.a[at]});
}

void Engine::Data::scale_inertia(const State& state, const Batch& batch, double dt) {
  const Template& shape = model.templates[batch.template_id];
  std::array<double, lane_width> mass_factor, rigid, deformation;
  std::array<double, 6 * lane_width> free;
  free.fill(1.0);
  for (int lane = 0; lane < batch.lanes; ++lane) {
    mass_factor[lane] = model.materials[batch.material_id].density * std::pow(batch.scale[lane], 3);
    const Inertia inertia = batch.bodies[lane] < 0 ? Inertia{} : model.inertia[batch.bodies[lane]];
    rigid[lane] = 1 / inertia.rigid, deformation[lane] = 1 / inertia.deformation;
    for (int i = 0; batch.bodies[lane] >= 0 && i < 6; ++i) {
      free[i * batch.lanes + lane] = free_motions[6 * batch.bodies[lane] + i];
    }
  }
  const Eigen::Vector3d gravity = model.gravity_on(batch.bodies[0]);
  kernels.scale_inertia({{gravity[0], gravity[1], gravity[2]},
                         model.local_damping,
                         relaxation_drag(model.local_damping, dt),
                         batch.lanes,
                         shape.n_nodes(),
                         shape.node_volumes.data(),
                         mass_factor.data(),
                         rigid.data(),
                         deformation.data(),
                         free.data(),
                         &state.x[batch.offset],
                         &state.v[batch.offset],
                         &force[batch.offset]});
}

void Engine::Data::add_load(const Batch& batch) {
  const int body = model.pad_body;
  const Template& shape = model.shape(body);
  const double volume = shape.volume();
  double* out = &force[batch.offset] + model.bodies[body].lane;
  for (int node = 0; node < shape.n_nodes(); ++node) {
    const double share = shape.node_volumes[node] / volume;
    for (int c = 0; c < 3; ++c) out[(3 * node + c) * batch.lanes] += share * model.pad_body_load[c];
  }
}

void Engine::Data::run(State& state, const Task& task, double dt, Span<const double> pad_force) {
  const Batch& batch = model.batches[task.batch];
  if (task.kind == TaskKind::blocks) return run_blocks(state, task);
  if (task.kind == TaskKind::nodes) {
    const cpu::ElementBlocks& blocks = *tasks.blocks[task.batch];
    kernels.gather({blocks.node_offsets.data(), blocks.node_copies.data(), task.first, task.last,
                    &slots[tasks.slot_offsets[task.batch]], &force[batch.offset]});
    if (!relaxing()) kick(state, batch, task.first, task.last, dt);
    return;
  }
  run_outer(state, task, pad_force);
  if (task.kind == TaskKind::outer) return;
  const Template& shape = model.templates[batch.template_id];
  const Material& solid = model.materials[batch.material_id];
  cpu::kernels_of(kernels, solid.interaction)
      .lane_forces({cpu::view_of(shape, solid.interaction), cpu::material_of(solid), batch.scale.data(),
                    &state.x[batch.offset], &state.v[batch.offset], &force[batch.offset]});
  if (relaxing()) scale_inertia(state, batch, dt);
  kick(state, batch, 0, shape.n_nodes(), dt);
}

void Engine::Data::run_blocks(const State& state, const Task& task) {
  const auto& law = cpu::kernels_of(kernels, model.materials[model.batches[task.batch].material_id].interaction);
  for (int b = task.first; b < task.last; ++b) law.block_forces(block_job(state, task, b));
}

cpu::BlockForces Engine::Data::block_job(const State& state, const Task& task, int b) {
  const Batch& batch = model.batches[task.batch];
  const cpu::ElementBlocks& all = *tasks.blocks[task.batch];
  const auto& block = all.blocks[b];
  return {cpu::material_of(model.materials[batch.material_id]),
          batch.scale[0],
          block.n_groups,
          block.n_copies,
          all.corners_of(block),
          all.numbers_of(block),
          &all.copies[block.first_copy],
          &state.x[batch.offset],
          &state.v[batch.offset],
          records[omp_get_thread_num()].data(),
          &slots[tasks.slot_offsets[task.batch] + std::int64_t{4} * block.first_copy]};
}

void Engine::Data::run_outer(const State& state, const Task& task, Span<const double> pad_force) {
  const Batch& batch = model.batches[task.batch];
  double* out = &force[batch.offset];
  std::fill(out, out + std::int64_t{3} * model.templates[batch.template_id].n_nodes() * batch.lanes, 0.0);
  for (int lane = 0; lane < batch.lanes; ++lane) {
    if (batch.bodies[lane] < 0) continue;
    contact.gather(batch.bodies[lane], force);
    loads.add(batch.bodies[lane], state, force);
    boundary.add(batch.bodies[lane], state, force);
    if (batch.bodies[lane] != model.pad_body) continue;
    pads.add_transposed(pad_force, force);
    if (!model.pad_body_load.isZero()) add_load(batch);
  }
}

void Engine::Data::begin_step(State& state, double dt, double time) {
  state.time = time;
  drift(state, dt);
  contact.update_candidates(state, moves);
  book_contacts(state.ledger, contact.compute(state, dt), dt);
  book_radiation(state, dt);
  book_work(state.ledger, loads.update(state, dt));
}

void Engine::Data::end_step(State& state, double dt, Span<const double> pad_force) {
#pragma omp parallel num_threads(n_threads)
  {
#pragma omp for schedule(dynamic, 1)
    for (std::size_t i = 0; i < tasks.forces.size(); ++i) run(state, tasks.forces[i], dt, pad_force);
#pragma omp for schedule(dynamic, 1)
    for (std::size_t i = 0; i < tasks.nodes.size(); ++i) run(state, tasks.nodes[i], dt, pad_force);
    if (relaxing()) {
#pragma omp for schedule(dynamic, 1)
      for (std::size_t i = 0; i < tasks.singles.size(); ++i) {
        const Batch& batch = model.batches[tasks.singles[i]];
        scale_inertia(state, batch, dt);
        kick(state, batch, 0, model.templates[batch.template_id].n_nodes(), dt);
      }
    }
  }
}

std::vector<double> Engine::Data::pad_values(const std::vector<double>& field) const {
  std::vector<double> values(pads.n_values());
  pads.apply(field, values);
  return values;
}

std::vector<double> Engine::Data::pad_displacement(const State& state) const {
  std::vector<double> x = pad_values(state.x);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= pad_reference[i];
  return x;
}

std::vector<double> Engine::Data::pad_forces(const State& state, const std::vector<double>& u,
                                             const std::vector<double>& rate, const std::vector<double>& x) const {
  std::vector<double> result(pads.n_values());
  pads.forces(u, rate, x, pad_values(state.v), result);
  return result;
}

void Engine::Data::add_pad_change(State& state, Span<const double> new_force) {
  if (pads.n_values() == 0) return;
  state.pad_force.resize(pads.n_values(), 0.0);
  std::vector<double> change(pads.n_values());
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = new_force[i] - state.pad_force[i];
  const Batch& batch = model.batches[model.bodies[model.pad_body].batch];
  const std::int64_t n = std::int64_t{3} * model.shape(model.pad_body).n_nodes() * batch.lanes;
  std::fill(&force[batch.offset], &force[batch.offset] + n, 0.0);
  pads.add_transposed(change, force);
  for (std::int64_t i = batch.offset; i < batch.offset + n; ++i) state.a[i] += force[i] * inverse_mass[i];
  state.pad_force.assign(new_force.begin(), new_force.end());
}

PadSums Engine::Data::advance_on_device(State& state, double dt, std::int64_t n_steps, const PadDrive* drive) {
  state.ledger = {};
  PadSums sums = device->advance(state, dt, n_steps, drive);
  device->show_contacts(state, contact);
  for (std::int64_t j = 0; options.on_step && j < n_steps; ++j) options.on_step();
  return sums;
}

void Engine::prepare(State& state) {
  if (data_->device) {
    data_->device->prepare(state);
    return data_->device->show_contacts(state, data_->contact);
  }
  state.resident.reset();
  omp_set_num_threads(data_->n_threads);
  data_->contact.update_candidates(state);
  state.ledger.contact_power = data_->contact.compute(state, 0.0);
  data_->loads.update(state, 0.0);
  state.pad_force.assign(data_->pads.n_values(), 0.0);
  data_->end_step(state, 0.0, state.pad_force);
}

void Engine::advance(State& state, double dt, std::int64_t n_steps) {
  Data& d = *data_;
  if (d.device) {
    d.advance_on_device(state, dt, n_steps, nullptr);
    return;
  }
  state.resident.reset();
  omp_set_num_threads(d.n_threads);  // the contact stage takes the program's number
  const std::vector<double> unloaded(d.pads.n_values(), 0.0);
  d.add_pad_change(state, unloaded);
  const double start = state.time;
  for (std::int64_t j = 1; j <= n_steps; ++j) {
    d.begin_step(state, dt, start + static_cast<double>(j) * dt);
    d.end_step(state, dt, unloaded);
    ++state.step;
    book_viscosity(state);
    if (d.options.on_step) d.options.on_step();
  }
}

PadSums Engine::advance(State& state, double dt, std::int64_t n_steps, const PadDrive& drive) {
  Data& d = *data_;
  if (d.device) return d.advance_on_device(state, dt, n_steps, &drive);
  state.resident.reset();
  omp_set_num_threads(d.n_threads);  // the contact stage takes the program's number
  const std::size_t n = d.pads.n_values();
  PadSums sums{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  std::vector<double> rate(n), u(drive.begin.begin(), drive.begin.end()), next_u(n);
  for (std::size_t i = 0; i < n; ++i) rate[i] = (drive.end[i] - drive.begin[i]) / (dt * static_cast<double>(n_steps));
  std::vector<double> x = d.pad_displacement(state);
  if (!d.relaxing()) d.add_pad_change(state, d.pad_forces(state, u, rate, x));
  const double start = state.time;
  for (std::int64_t j = 1; j <= n_steps; ++j) {
    d.begin_step(state, dt, start + static_cast<double>(j) * dt);
    const double share = static_cast<double>(j) / static_cast<double>(n_steps);
    for (std::size_t i = 0; i < n; ++i) next_u[i] = drive.begin[i] + share * (drive.end[i] - drive.begin[i]);
    const std::vector<double> next_x = d.pad_displacement(state);
    const std::vector<double> next_force = d.pad_forces(state, next_u, rate, next_x);
    d.end_step(state, dt, next_force);
    double work = 0.0;  // on the sleeper
    for (std::size_t i = 0; i < n; ++i) {
      const double mean = 0.5 * (state.pad_force[i] + next_force[i]);
      sums.impulse[i] += dt * mean;
      sums.work[i] += mean * (next_u[i] - u[i]);
      work += mean * (next_x[i] - x[i]);
    }
    Data::book_work(state.ledger, work);
    state.pad_force = next_force, u = next_u, x = next_x;
    ++state.step;
    book_viscosity(state);
    if (d.options.on_step) d.options.on_step();
  }
  return sums;
}

}  // namespace qdem
