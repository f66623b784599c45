// Sensors on states whose readings are known, and their keys.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/output/contacts_file.hpp"
#include "qdem_solver/participant/qdem_case.hpp"
#include "qdem_solver/sensors/sensor_file.hpp"
#include "tests/support/small_bed.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using tests::near_abs;

const char* const all_sensors = R"(sensor_interval_s = 1e-3
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
[[qdem.sensor]]
name = "layer"
kind = "stones"
[[qdem.sensor]]
name = "sleeper"
kind = "bottom"
cells = [3, 4]
)";

class Sensors : public testing::Test {
 protected:
  proto::CaseFile file_ = proto::CaseFile::load(tests::small_bed_case(testing::TempDir(), all_sensors));
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

TEST_F(Sensors, AtRestPressuresAndPairForcesCarryTheWeights) {
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

  qdem::ContactsFile contacts(path_ + ".contacts", {});
  contacts.write(0.25, bed_.state, engine.contacts());
  contacts.close();
  const proto::ResultReader pairs(path_ + ".contacts");
  const auto a = pairs.read("/body_a").values, b = pairs.read("/body_b").values, f = pairs.read("/force").values;
  ASSERT_EQ(pairs.n_committed("/"), 24u);  // every stone touches the sleeper and the ground
  std::vector<double> up(13, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(pairs.read("/time").values[i], 0.25);
    up[static_cast<std::size_t>(a[i])] += f[3 * i + 2];
    if (b[i] >= 0) up[static_cast<std::size_t>(b[i])] -= f[3 * i + 2];
  }
  for (int body = 0; body <= 12; ++body) {
    EXPECT_TRUE(near_abs(up[body], 9.81 * model.body_mass(body), 0.02 * 9.81 * model.body_mass(0))) << body;
  }
}

TEST_F(Sensors, EveryStonesCentreIsMeasured) {
  const qdem::Model& model = bed_.model;
  qdem::Engine engine(model);
  engine.prepare(bed_.state);
  qdem::SensorFile sensors(path_, settings_.sensors, model, bed_.state, {});
  sensors.look(0.0, bed_.state, engine.contacts());
  const auto shift = [](int body) { return Vector3d(1e-3 * body, -2e-3 * body, 0.5e-3); };
  const auto speed = [](int body) { return Vector3d(0.1, 0.2 * body, 0.3); };
  qdem::State moved = bed_.state;
  for (int body = 0; body <= 12; ++body) {
    for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
      qdem::State::scatter(model, moved.x, body, i, bed_.state.position(model, body, i) + shift(body));
      qdem::State::scatter(model, moved.v, body, i, speed(body));
    }
  }
  sensors.look(1e-3, moved, engine.contacts());
  sensors.close();

  const proto::ResultReader reader(path_);
  EXPECT_EQ(reader.shape("/layer/position"), (std::vector<std::size_t>{2, 12, 3}));
  EXPECT_EQ(reader.text("/", "layer.kind"), "stones");
  const auto before = row(reader, "/layer/position", 36, 0), after = row(reader, "/layer/position", 36, 1),
             velocity = row(reader, "/layer/velocity", 36, 1);
  for (int stone = 0; stone < 12; ++stone) {
    const int body = stone + 1;  // body 0 is the sleeper
    const Vector3d centre(-0.11 + 0.1 * (stone % 3), 0.59 + 0.1 * (stone / 3), -0.132);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(near_abs(before[3 * stone + axis], centre[axis], 1e-12));
      EXPECT_TRUE(near_abs(after[3 * stone + axis] - before[3 * stone + axis], shift(body)[axis], 1e-12));
      EXPECT_TRUE(near_abs(velocity[3 * stone + axis], speed(body)[axis], 1e-12));
    }
  }
}

TEST_F(Sensors, TheBottomIsMeasuredCellByCell) {
  const qdem::Model& model = bed_.model;
  qdem::Engine engine(model);
  engine.prepare(bed_.state);
  qdem::SensorFile sensors(path_, settings_.sensors, model, bed_.state, {});
  sensors.look(0.0, bed_.state, engine.contacts());
  // A field linear in x and y: a cell's mean is its value at the cell's centre. In the four corner cells the centre of
  // the particles' shares is off by a millimetre: a corner of the mesh belongs to one triangle or to two.
  const auto tolerance = [](int cell) { return cell == 0 || cell == 3 || cell == 8 || cell == 11 ? 5e-3 : 1e-12; };
  const auto field = [](const Vector3d& x) { return Vector3d(x[0] + 2 * x[1], 3 * x[0], 0.1 - x[1]); };
  qdem::State moved = bed_.state;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    const Vector3d x = bed_.state.position(model, 0, i);
    qdem::State::scatter(model, moved.x, 0, i, x + 1e-3 * field(x));
    qdem::State::scatter(model, moved.v, 0, i, field(x));
  }
  sensors.look(1e-3, moved, engine.contacts());
  sensors.close();

  const proto::ResultReader reader(path_);
  EXPECT_TRUE(near_abs(reader.number("/", "sleeper.x_min_m"), -0.15, 1e-12));
  EXPECT_TRUE(near_abs(reader.number("/", "sleeper.y_max_m"), 0.95, 1e-12));
  EXPECT_TRUE(near_abs(reader.number("/", "sleeper.z_m"), -0.1, 1e-12));
  const auto displacement = row(reader, "/sleeper/displacement", 36, 1),
             velocity = row(reader, "/sleeper/velocity", 36, 1);
  for (int cell = 0; cell < 12; ++cell) {
    const Vector3d centre(-0.1 + 0.1 * (cell / 4), 0.6 + 0.1 * (cell % 4), -0.1);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(near_abs(displacement[3 * cell + axis], 1e-3 * field(centre)[axis], 1e-3 * tolerance(cell)));
      EXPECT_TRUE(near_abs(velocity[3 * cell + axis], field(centre)[axis], tolerance(cell)));
    }
  }
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
  EXPECT_EQ(refusal(interval + "[[qdem.sensor]]\nname = \"a\"\nkind = \"stones\"\n"), "accepted");
  EXPECT_NE(refusal(interval + "[[qdem.sensor]]\nname = \"a\"\nkind = \"bottom\"\n").find("cells"), std::string::npos);
  EXPECT_NE(refusal(interval + "[[qdem.sensor]]\nname = \"a\"\nkind = \"stne\"\n").find("stone"), std::string::npos);
  EXPECT_NE(refusal(interval + "[[qdem.sensor]]\nname = \"a\"\nkind = \"pressure\"\ncells = [0, 2]\n").find("cells"),
            std::string::npos);
}

}  // namespace
