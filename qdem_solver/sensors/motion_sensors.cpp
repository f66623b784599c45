#include <Eigen/Geometry>
#include <limits>

#include "proto/error.hpp"
#include "qdem_solver/sensors/mass_mean.hpp"
#include "qdem_solver/sensors/sensor.hpp"
#include "qdem_solver/state/rigid_fit.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;

void put_vector(proto::TimeSeriesFile& file, const std::string& name, const Vector3d& value) {
  file.put(name, proto::Span<const double>(value.data(), 3));
}

/// Displacement, velocity and acceleration of a point. The acceleration is the change of velocity since the last row
/// over the time between: a mean over the interval, so that what is faster than the sampling does not fold into it as
/// it would in a momentary value. Displacement and velocity are momentary.
class MotionColumns {
 public:
  MotionColumns(std::string name, const Vector3d& start) : name_(std::move(name)), start_(start) {}

  std::vector<proto::Column> columns() const {
    return {{name_ + "/displacement", "m", "global axes, since time 0", {3}},
            {name_ + "/velocity", "m/s", "global axes", {3}},
            {name_ + "/acceleration", "m/s2", "global axes, mean over the interval before", {3}}};
  }

  void put(proto::TimeSeriesFile& file, const Vector3d& position, const Vector3d& velocity, double elapsed) {
    put_vector(file, name_ + "/displacement", position - start_);
    put_vector(file, name_ + "/velocity", velocity);
    put_vector(file, name_ + "/acceleration",
               elapsed > 0 ? Vector3d((velocity - before_) / elapsed) : Vector3d(0, 0, 0));
    before_ = velocity;
  }

  void exchange(proto::StateArchive& archive) {
    std::vector<Vector3d> before{before_};
    archive("sensors/" + name_ + "/velocity_before", before);
    archive.expect_length("sensors/" + name_ + "/velocity_before", before.size(), 1);
    before_ = before.front();
  }

 private:
  std::string name_;
  Vector3d start_, before_ = Vector3d::Zero();
};

class StoneSensor : public Sensor {
 public:
  StoneSensor(const std::string& name, const Model& model, const State& reference, int body)
      : name_(name),
        model_(model),
        body_(body),
        start_(rigid_fit(model, reference, body, model.bodies[body].scale).rotation),
        centre_(mass_mean(model, reference.x, body)),
        motion_(name, centre_) {}

  std::vector<proto::Column> columns() const override {
    auto all = motion_.columns();
    all.push_back({name_ + "/rotation", "rad", "rotation vector, global axes, since time 0", {3}});
    return all;
  }

  proto::Attributes place() const override {
    return {{name_ + ".body", static_cast<std::int64_t>(body_)},
            {name_ + ".x_m", centre_[0]},
            {name_ + ".y_m", centre_[1]},
            {name_ + ".z_m", centre_[2]}};
  }

  void put(proto::TimeSeriesFile& file, const State& state, const ContactStage&, double elapsed) override {
    motion_.put(file, mass_mean(model_, state.x, body_), mass_mean(model_, state.v, body_), elapsed);
    const auto now = rigid_fit(model_, state, body_, model_.bodies[body_].scale).rotation;
    const Eigen::AngleAxisd turn(now * start_.transpose());
    put_vector(file, name_ + "/rotation", turn.angle() * turn.axis());
  }

  void exchange(proto::StateArchive& archive) override { motion_.exchange(archive); }

 private:
  std::string name_;
  const Model& model_;
  int body_;
  Eigen::Matrix3d start_;
  Vector3d centre_;
  MotionColumns motion_;
};

class ParticleSensor : public Sensor {
 public:
  ParticleSensor(const std::string& name, const Model& model, const State& reference, int body, int node)
      : name_(name),
        model_(model),
        body_(body),
        node_(node),
        start_(reference.position(model, body, node)),
        motion_(name, start_) {}

  std::vector<proto::Column> columns() const override { return motion_.columns(); }

  proto::Attributes place() const override {
    return {{name_ + ".body", static_cast<std::int64_t>(body_)},
            {name_ + ".particle", static_cast<std::int64_t>(node_)},
            {name_ + ".x_m", start_[0]},
            {name_ + ".y_m", start_[1]},
            {name_ + ".z_m", start_[2]}};
  }

  void put(proto::TimeSeriesFile& file, const State& state, const ContactStage&, double elapsed) override {
    motion_.put(file, state.position(model_, body_, node_), state.velocity(model_, body_, node_), elapsed);
  }

  void exchange(proto::StateArchive& archive) override { motion_.exchange(archive); }

 private:
  std::string name_;
  const Model& model_;
  int body_, node_;
  Vector3d start_;
  MotionColumns motion_;
};

}  // namespace

std::unique_ptr<Sensor> make_stone_sensor(const SensorSettings& settings, const Model& model, const State& reference) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    if (model.bodies[body].kind != BodyKind::stone) continue;
    const double distance = (mass_mean(model, reference.x, body) - settings.point).norm();
    if (distance < least) least = distance, nearest = body;
  }
  if (nearest < 0) {
    throw proto::Error(proto::ExitCode::bad_data, "there is no stone to measure", "sensor '" + settings.name + "'");
  }
  return std::make_unique<StoneSensor>(settings.name, model, reference, nearest);
}

std::unique_ptr<Sensor> make_particle_sensor(const SensorSettings& settings, const Model& model,
                                             const State& reference) {
  int nearest = 0, particle = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    for (const int node : model.shape(body).surface_nodes) {
      const double distance = (reference.position(model, body, node) - settings.point).norm();
      if (distance < least) least = distance, nearest = body, particle = node;
    }
  }
  return std::make_unique<ParticleSensor>(settings.name, model, reference, nearest, particle);
}

}  // namespace qdem
