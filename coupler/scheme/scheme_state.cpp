#include "coupler/scheme/scheme_state.hpp"

#include <string>

namespace coupler {
namespace {

void exchange_columns(proto::StateArchive& archive, AccelerationState& memory, std::size_t n_values) {
  std::vector<double> residuals, images;
  std::vector<std::int64_t> counts(memory.columns_of_window.begin(), memory.columns_of_window.end());
  for (const auto& column : memory.columns) {
    residuals.insert(residuals.end(), column.residual.begin(), column.residual.end());
    images.insert(images.end(), column.image.begin(), column.image.end());
  }
  archive("scheme/acceleration/residuals", residuals);
  archive("scheme/acceleration/images", images);
  archive("scheme/acceleration/columns_of_window", counts);
  archive.expect_length("scheme/acceleration/images", images.size(), residuals.size());
  archive.expect_length("scheme/acceleration/residuals", residuals.size() % n_values, 0);
  memory.columns_of_window.assign(counts.begin(), counts.end());
  memory.columns.clear();
  for (std::size_t i = 0; i < residuals.size(); i += n_values)
    memory.columns.push_back({{&residuals[i], &residuals[i] + n_values}, {&images[i], &images[i] + n_values}});
}

}  // namespace

void SchemeState::exchange(proto::StateArchive& archive, std::size_t n_values) {
  const auto list = [&](const char* name, std::vector<double>& values) {
    archive(std::string("scheme/") + name, values);
    archive.expect_length(name, values.size(), n_values);
  };
  list("rail_displacement", interface.rail_displacement);
  list("rail_velocity", interface.rail_velocity);
  list("sleeper_displacement", interface.sleeper_displacement);
  list("sleeper_velocity", interface.sleeper_velocity);
  list("sleeper_acceleration", sleeper_acceleration);
  list("force_carry", force_carry);
  list("force_mean", force_mean);
  list("force_mean_before", force_mean_before);
  archive("scheme/force_scale", force_scale);
  archive("scheme/displacement_scale", displacement_scale);
  archive("scheme/relaxation", acceleration.relaxation);
  exchange_columns(archive, acceleration, n_values);
  archive("scheme/joint/force", joint.force);
  archive("scheme/joint/rail_operator", joint.rail_operator);
  archive("scheme/joint/sleeper_operator", joint.sleeper_operator);
  archive("scheme/sub_cycles", sub_cycles);
  archive("scheme/rail_known", rail_known);
}

}  // namespace coupler
