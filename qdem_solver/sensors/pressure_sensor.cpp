#include <algorithm>

#include "qdem_solver/sensors/bottom_cells.hpp"
#include "qdem_solver/sensors/sensor.hpp"

namespace qdem {
namespace {

class PressureSensor : public Sensor {
 public:
  PressureSensor(const SensorSettings& settings, const Model& model, const State& reference)
      : name_(settings.name),
        model_(model),
        cells_(model, settings.cells),
        place_(cells_.place(name_, reference)),
        force_(model.n_values) {}

  std::vector<proto::Column> columns() const override {
    return {{name_ + "/pressure", "Pa", "upward, on the sleeper's bottom: cells along x, then along y", cells_.shape()},
            {name_ + "/force", "N", "upward, of all cells", {}}};
  }

  proto::Attributes place() const override { return place_; }

  void put(proto::TimeSeriesFile& file, const State&, const ContactStage& contacts, double) override {
    std::fill(force_.begin(), force_.end(), 0.0);
    contacts.gather(cells_.body(), force_);
    std::vector<double> pressure(cells_.n_cells(), 0.0);
    double sum = 0.0;
    for (const auto& [node, cell] : cells_.quarters()) {
      const double up = 0.25 * State::gather(model_, force_, cells_.body(), node)[2];
      pressure[cell] += up / (cells_.cell_length(0) * cells_.cell_length(1));
      sum += up;
    }
    file.put(name_ + "/pressure", pressure);
    file.put(name_ + "/force", sum);
  }

 private:
  std::string name_;
  const Model& model_;
  BottomCells cells_;
  proto::Attributes place_;
  std::vector<double> force_;
};

}  // namespace

std::unique_ptr<Sensor> make_pressure_sensor(const SensorSettings& settings, const Model& model,
                                             const State& reference) {
  return std::make_unique<PressureSensor>(settings, model, reference);
}

}  // namespace qdem
