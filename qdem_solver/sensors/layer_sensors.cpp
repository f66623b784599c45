#include <Eigen/Geometry>

#include "proto/error.hpp"
#include "qdem_solver/sensors/bottom_cells.hpp"
#include "qdem_solver/sensors/mass_mean.hpp"
#include "qdem_solver/sensors/sensor.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;

class StonesSensor : public Sensor {
 public:
  StonesSensor(std::string name, const Model& model) : name_(std::move(name)), model_(model) {
    for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
      if (model.bodies[body].kind == BodyKind::stone) stones_.push_back(body);
    }
    if (stones_.empty()) {
      throw proto::Error(proto::ExitCode::bad_data, "there is no stone to measure", "sensor '" + name_ + "'");
    }
  }

  std::vector<proto::Column> columns() const override {
    const std::vector<std::size_t> shape = {stones_.size(), 3};
    return {{name_ + "/position", "m", "centres of mass, stones in order of their numbers, global axes", shape},
            {name_ + "/velocity", "m/s", "of the centres", shape}};
  }

  proto::Attributes place() const override { return {}; }

  void put(proto::TimeSeriesFile& file, const State& state, const ContactStage&, double) override {
    file.put(name_ + "/position", centres(state.x));
    file.put(name_ + "/velocity", centres(state.v));
  }

 private:
  std::vector<double> centres(const std::vector<double>& values) const {
    std::vector<double> result;
    result.reserve(3 * stones_.size());
    for (const int stone : stones_) {
      const Vector3d mean = mass_mean(model_, values, stone);
      result.insert(result.end(), mean.data(), mean.data() + 3);
    }
    return result;
  }

  std::string name_;
  const Model& model_;
  std::vector<int> stones_;
};

class BottomSensor : public Sensor {
 public:
  BottomSensor(const SensorSettings& settings, const Model& model, const State& reference)
      : name_(settings.name), model_(model), cells_(model, settings.cells), place_(cells_.place(name_, reference)) {
    const Template& shape = model.shape(cells_.body());
    std::vector<bool> at_bottom(shape.nodes.size(), false);
    for (const auto& quarter : cells_.quarters()) at_bottom[quarter.node] = true;
    areas_.assign(shape.nodes.size(), 0.0);
    for (const Triangle& triangle : shape.triangles) {
      const auto& n = triangle.nodes;
      if (!at_bottom[n[0]] || !at_bottom[n[1]] || !at_bottom[n[2]]) continue;
      const Vector3d p = shape.nodes[n[1]] - shape.nodes[n[0]], q = shape.nodes[n[2]] - shape.nodes[n[0]];
      for (const int node : n) areas_[node] += p.cross(q).norm() / 6;
    }
    cell_areas_.assign(cells_.n_cells(), 0.0);
    for (const auto& [node, cell] : cells_.quarters()) cell_areas_[cell] += areas_[node];
    for (const double area : cell_areas_) {
      if (area > 0) continue;
      throw proto::Error(proto::ExitCode::bad_data, "a cell of the sleeper's bottom holds no particle",
                         "sensor '" + name_ + "'", "give fewer cells");
    }
    start_ = means(reference.x);
  }

  std::vector<proto::Column> columns() const override {
    auto shape = cells_.shape();
    shape.push_back(3);
    return {
        {name_ + "/displacement", "m", "mean over each cell of the sleeper's bottom, global axes, since time 0", shape},
        {name_ + "/velocity", "m/s", "the same mean", shape}};
  }

  proto::Attributes place() const override { return place_; }

  void put(proto::TimeSeriesFile& file, const State& state, const ContactStage&, double) override {
    auto displacement = means(state.x);
    for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] -= start_[i];
    file.put(name_ + "/displacement", displacement);
    file.put(name_ + "/velocity", means(state.v));
  }

 private:
  /// Means over the cells, weighted by the particles' areas.
  std::vector<double> means(const std::vector<double>& values) const {
    std::vector<double> result(3 * cells_.n_cells(), 0.0);
    for (const auto& [node, cell] : cells_.quarters()) {
      const Vector3d value = State::gather(model_, values, cells_.body(), node);
      for (int c = 0; c < 3; ++c) result[3 * cell + c] += areas_[node] / cell_areas_[cell] * value[c];
    }
    return result;
  }

  std::string name_;
  const Model& model_;
  BottomCells cells_;
  proto::Attributes place_;
  std::vector<double> areas_;       ///< of each particle's share of the bottom [m2], at scale 1
  std::vector<double> cell_areas_;  ///< sums over the quarters of a cell
  std::vector<double> start_;
};

}  // namespace

std::unique_ptr<Sensor> make_stones_sensor(const SensorSettings& settings, const Model& model) {
  return std::make_unique<StonesSensor>(settings.name, model);
}

std::unique_ptr<Sensor> make_bottom_sensor(const SensorSettings& settings, const Model& model, const State& reference) {
  return std::make_unique<BottomSensor>(settings, model, reference);
}

}  // namespace qdem
