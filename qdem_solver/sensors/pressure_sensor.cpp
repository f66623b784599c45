#include <algorithm>
#include <cmath>
#include <limits>

#include "qdem_solver/sensors/sensor.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;

constexpr double same_place = 1e-9;  // [template lengths]

class PressureSensor : public Sensor {
 public:
  PressureSensor(const SensorSettings& settings, const Model& model)
      : name_(settings.name), cells_(settings.cells), model_(model), body_(model.pad_body), force_(model.n_values) {
    const Template& shape = model.shape(body_);
    low_ = high_ = shape.nodes.front();
    for (const Vector3d& node : shape.nodes) low_ = low_.cwiseMin(node), high_ = high_.cwiseMax(node);
    for (const int node : shape.surface_nodes) {
      const Vector3d& at = shape.nodes[node];
      if (at[2] <= low_[2] + same_place) add_bottom(node, at);
    }
  }

  std::vector<proto::Column> columns() const override {
    const std::vector<std::size_t> grid = {static_cast<std::size_t>(cells_[0]), static_cast<std::size_t>(cells_[1])};
    return {{name_ + "/pressure", "Pa", "upward, on the sleeper's bottom: cells along x, then along y", grid},
            {name_ + "/force", "N", "upward, of all cells", {}}};
  }

  proto::Attributes place() const override {
    return {{name_ + ".cell_length_m", cell_length(0)}, {name_ + ".cell_width_m", cell_length(1)}};
  }

  void put(proto::TimeSeriesFile& file, const State&, const ContactStage& contacts, double) override {
    std::fill(force_.begin(), force_.end(), 0.0);
    contacts.gather(body_, force_);
    std::vector<double> pressure(static_cast<std::size_t>(cells_[0]) * cells_[1], 0.0);
    double sum = 0.0;
    for (const auto& [node, cell] : bottom_) {
      const double up = 0.25 * State::gather(model_, force_, body_, node)[2];
      pressure[cell] += up / (cell_length(0) * cell_length(1));
      sum += up;
    }
    file.put(name_ + "/pressure", pressure);
    file.put(name_ + "/force", sum);
  }

 private:
  /// A particle on the line between cells belongs to both, on a corner to four.
  void add_bottom(int node, const Vector3d& at) {
    for (const double dx : {-same_place, same_place}) {
      for (const double dy : {-same_place, same_place}) bottom_.push_back({node, cell_of(at + Vector3d(dx, dy, 0))});
    }
  }

  double cell_length(int axis) const { return model_.bodies[body_].scale * (high_[axis] - low_[axis]) / cells_[axis]; }

  int cell_of(const Vector3d& at) const {
    int index[2];
    for (int axis = 0; axis < 2; ++axis) {
      const double share = (at[axis] - low_[axis]) / (high_[axis] - low_[axis]);
      index[axis] = std::clamp(static_cast<int>(std::floor(share * cells_[axis])), 0, cells_[axis] - 1);
    }
    return index[0] * cells_[1] + index[1];
  }

  /// A quarter of a bottom particle's force.
  struct Quarter {
    int node, cell;
  };

  std::string name_;
  std::array<int, 2> cells_;
  const Model& model_;
  int body_;
  Vector3d low_, high_;  ///< of the template's box
  std::vector<Quarter> bottom_;
  std::vector<double> force_;
};

}  // namespace

std::unique_ptr<Sensor> make_pressure_sensor(const SensorSettings& settings, const Model& model) {
  return std::make_unique<PressureSensor>(settings, model);
}

}  // namespace qdem
