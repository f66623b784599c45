// Sensors on states whose readings are known, and their keys.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/participant/qdem_case.hpp"
#include "qdem_solver/sensors/sensor_file.hpp"
#include "tests/support/small_bed.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using tests::near_abs;

const char* const three_sensors = R"(sensor_interval_s = 1e-3
[[qdem.sensor]]
name = "deep"
kind = "stone"
point_m = [-0.05, 0.65, -0.2]
[[qdem.sensor]]
name = "corner"
kind = "particle"
point_m = [-0.2, 0.5, 0.1]
[[qdem.sensor]]
name = "bottom"
kind = "pressure"
cells = [3, 4]
)";

class Sensors : public testing::Test {
 protected:
  proto::CaseFile file_ = proto::CaseFile::load(tests::small_bed_case(testing::TempDir(), three_sensors));
  qdem::QdemCase settings_ = qdem::read_qdem_case(file_);
  qdem::Bed bed_ = tests::small_bed(file_, settings_.physics);
  std::string path_ = testing::TempDir() + "/sensors_" + std::to_string(getpid()) + ".h5";

  std::vector<double> row(const proto::ResultReader& reader, const std::string& name, std::size_t n, std::size_t row) {
    const auto values = reader.read(name).values;
    return {values.begin() + static_cast<std::ptrdiff_t>(n * row),
            values.begin() + static_cast<std::ptrdiff_t>(n * (row + 1))};
  }
};

TEST_F(Sensors, AStoneIsMeasuredAsTheRigidBodyItIs) {
  const qdem::Model& model = bed_.model;
  qdem::Engine engine(model);
  engine.prepare(bed_.state);
  qdem::SensorFile sensors(path_, settings_.sensors, model, bed_.state, {});
  sensors.look(0.0, bed_.state, engine.contacts());

  // Stone 4 is the cube at x = -0.04, y = 0.66: body 5. It turns about its centre, moves and speeds up.
  constexpr int body = 5;
  const Eigen::Vector3d turn(0.02, -0.03, 0.05), shift(1e-3, 2e-3, -3e-3), speed(0.1, 0.2, 0.3);
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  Vector3d centre = Vector3d::Zero();
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
    centre += model.node_mass(body, i) / model.body_mass(body) * bed_.state.position(model, body, i);
  }
  qdem::State moved = bed_.state;
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
    const Vector3d x = bed_.state.position(model, body, i);
    qdem::State::scatter(model, moved.x, body, i, centre + shift + rotation * (x - centre));
    qdem::State::scatter(model, moved.v, body, i, speed);
  }
  sensors.look(0.4e-3, moved, engine.contacts());  // not due
  sensors.look(1e-3, moved, engine.contacts());
  sensors.close();

  const proto::ResultReader reader(path_);
  ASSERT_EQ(reader.n_committed("/"), 2u);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(near_abs(row(reader, "/deep/displacement", 3, 1)[axis], shift[axis], 1e-12));
    EXPECT_TRUE(near_abs(row(reader, "/deep/rotation", 3, 1)[axis], turn[axis], 1e-12));
    EXPECT_TRUE(near_abs(row(reader, "/deep/acceleration", 3, 1)[axis], speed[axis] / 1e-3, 1e-9));
    EXPECT_EQ(row(reader, "/deep/acceleration", 3, 0)[axis], 0.0);
    EXPECT_EQ(row(reader, "/corner/displacement", 3, 1)[axis], 0.0);  // of the sleeper, which did not move
  }
}

TEST_F(Sensors, ThePressuresCarryTheSleeper) {
  qdem::Model& model = bed_.model;
  model.local_damping = 0.7;
  qdem::Engine engine(model, {1});
  engine.prepare(bed_.state);
  engine.advance(bed_.state, 2e-6, 60000);
  qdem::SensorFile sensors(path_, settings_.sensors, model, bed_.state, {});
  sensors.look(0.0, bed_.state, engine.contacts());
  sensors.close();
  const proto::ResultReader reader(path_);
  const double weight = 9.81 * model.body_mass(0), area = 0.1 * 0.1;
  double sum = 0.0;
  for (const double pressure : row(reader, "/bottom/pressure", 12, 0)) {
    EXPECT_GT(pressure, 0.0);  // a stone under every cell
    sum += pressure * area;
  }
  EXPECT_TRUE(tests::near_rel(sum, weight, 0.02));
  EXPECT_TRUE(tests::near_rel(row(reader, "/bottom/force", 1, 0)[0], sum, 1e-12));
}

TEST(SensorKeys, AreChecked) {
  const auto refusal = [](const std::string& keys) -> std::string {
    try {
      qdem::read_qdem_case(proto::CaseFile::load(tests::small_bed_case(testing::TempDir(), keys)));
    } catch (const proto::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string sensor = "[[qdem.sensor]]\nname = \"a\"\nkind = \"stone\"\npoint_m = [0, 0, 0]\n";
  EXPECT_NE(refusal(sensor).find("qdem.sensor_interval_s"), std::string::npos) << refusal(sensor);
  const std::string interval = "sensor_interval_s = 1e-3\n";
  EXPECT_EQ(refusal(interval + sensor), "accepted");
  EXPECT_NE(refusal(interval + sensor + sensor).find("another sensor"), std::string::npos);
  EXPECT_NE(
      refusal(interval + "[[qdem.sensor]]\nname = \"a/b\"\nkind = \"stone\"\npoint_m = [0, 0, 0]\n").find("group"),
      std::string::npos);
  EXPECT_NE(refusal(interval + "[[qdem.sensor]]\nname = \"a\"\nkind = \"stne\"\n").find("stone"), std::string::npos);
  EXPECT_NE(refusal(interval + "[[qdem.sensor]]\nname = \"a\"\nkind = \"pressure\"\ncells = [0, 2]\n").find("cells"),
            std::string::npos);
}

}  // namespace
