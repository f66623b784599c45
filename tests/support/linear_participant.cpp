// One side of a test problem of linear_problems.hpp: `--problem NAME --side rail|sleeper --step LARGEST_STEP`.
// `--fault nearest_point`: a rail with points of its own that holds its pad against the motion of the point nearest to
// each cell, not against the operator that the coupler sends; no_cutoff: its pads pull.
#include <cstdio>
#include <memory>
#include <string>

#include "proto/case/rail_seat.hpp"
#include "proto/session/participant.hpp"
#include "tests/support/command_option.hpp"
#include "tests/support/linear_problems.hpp"

namespace {

namespace field = proto::field;

/// What a node at each point registers: it moves as the body does, and takes the force of its point.
proto::SeatRegistration registration(const proto::RailSeat& seat, const std::vector<Eigen::Vector3d>& points) {
  proto::SeatRegistration r;
  r.name = seat.name;
  const Eigen::Index n = static_cast<Eigen::Index>(points.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> response(6, 3 * n), resultants(3 * n, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& point = points[static_cast<std::size_t>(i)];
    r.points.insert(r.points.end(), point.data(), point.data() + 3);
    r.weights.push_back(1.0 / static_cast<double>(n));
    for (Eigen::Index k = 0; k < 3; ++k) {
      response.row(k).segment<3>(3 * i) = seat.axes.row(k);
      response.row(3 + k).segment<3>(3 * i) =
          (seat.axes.transpose() * Eigen::Vector3d::Unit(k).cross(point - seat.origin)).transpose();
      resultants.row(3 * i + k) << seat.axes.col(k).transpose(),
          (point - seat.origin).cross(seat.axes.col(k)).transpose();
    }
  }
  r.rigid_response.assign(response.data(), response.data() + response.size());
  r.force_resultants.assign(resultants.data(), resultants.data() + resultants.size());
  return r;
}

std::vector<Eigen::Vector3d> cells_of(const proto::RailSeat& seat) {
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < seat.n_cells(); ++c) points.push_back(seat.cell_point(c));
  return points;
}

/// What both sides do alike.
class LinearParticipant : public proto::Participant {
 public:
  LinearParticipant(std::string name, tests::LinearProblem problem, std::vector<proto::RailSeat> seats)
      : name_(std::move(name)), problem_(std::move(problem)), seats_(std::move(seats)) {}
  std::string name() const override { return name_; }
  std::string build_id() const override { return "linear_participant"; }
  proto::Capabilities capabilities() const override { return {true, true, false, false}; }
  proto::FieldSet advance(const proto::Advance& request, proto::Progress& progress) override {
    progress.bump();
    return side().advance(request).data;
  }
  void commit(const proto::Commit& request) override { side().commit(request); }
  void rollback(const proto::Rollback& request) override { side().rollback(request); }
  std::vector<proto::Fact> finish() override { return {}; }

 protected:
  virtual coupler::Side& side() = 0;

  std::string name_;
  tests::LinearProblem problem_;
  std::vector<proto::RailSeat> seats_;
};

class Rail : public LinearParticipant {
 public:
  Rail(std::string name, tests::LinearProblem problem, std::vector<proto::RailSeat> seats, std::string fault)
      : LinearParticipant(std::move(name), std::move(problem), std::move(seats)), fault_(std::move(fault)) {}

  proto::Interface describe() override {
    proto::Interface interface;
    for (const auto* name : {field::sleeper_mean_displacement, field::sleeper_mean_velocity})
      interface.fields.push_back({name, name == field::sleeper_mean_velocity ? "m/s" : "m", 3, false});
    for (const auto* name : {field::force_carry, field::force_mean, field::joint_force_begin, field::joint_force})
      interface.fields.push_back({name, "N", 3, false});
    interface.fields.push_back({field::rail_displacement, "m", 3, true});
    interface.fields.push_back({field::rail_velocity, "m/s", 3, true});
    interface.fields.push_back({field::force_robin, "N", 3, true});
    interface.fields.push_back({field::force_used, "N", 3, true});
    for (const auto& seat : seats_) {
      const bool own = !problem_.rail_points.empty();
      interface.seats.push_back(registration(seat, own ? problem_.rail_points : cells_of(seat)));
      interface.seats.back().own_points = own;
    }
    return interface;
  }
  proto::Configured configure(const proto::Configure& request) override {
    auto laws = problem_.laws();
    if (fault_ == "no_cutoff")
      for (auto& law : laws) law.tension_cutoff = false;
    rail_ = std::make_unique<tests::LinearRail>(problem_.rail, tests::RailPad{laws, map_from(request.pad_map)});
    return {};
  }
  proto::FieldSet start() override { return rail_->motion(); }

 private:
  coupler::Side& side() override { return *rail_; }

  /// Normal components of the one seat's operator; the identity where the cells were registered.
  Eigen::MatrixXd map_from(const std::vector<double>& sent) const {
    const auto cells = static_cast<Eigen::Index>(problem_.n_cells()), points = problem_.rail.points.rows();
    if (sent.empty()) return Eigen::MatrixXd::Identity(cells, points);
    Eigen::MatrixXd map(cells, points);
    for (Eigen::Index i = 0; i < cells; ++i)
      for (Eigen::Index j = 0; j < points; ++j)
        map(i, j) = sent.at(static_cast<std::size_t>((3 * i + 2) * 3 * points + 3 * j + 2));
    return fault_ == "nearest_point" ? nearest() : map;
  }
  Eigen::MatrixXd nearest() const {
    const auto cells = cells_of(seats_.front());
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(cells.size()), problem_.rail.points.rows());
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::size_t best = 0;
      for (std::size_t p = 0; p < problem_.rail_points.size(); ++p)
        if ((problem_.rail_points[p] - cells[c]).norm() < (problem_.rail_points[best] - cells[c]).norm()) best = p;
      map(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(best)) = 1.0;
    }
    return map;
  }

  std::string fault_;
  std::unique_ptr<tests::LinearRail> rail_;
};

class Sleeper : public LinearParticipant {
 public:
  Sleeper(std::string name, tests::LinearProblem problem, std::vector<proto::RailSeat> seats, double step)
      : LinearParticipant(std::move(name), std::move(problem), std::move(seats)),
        step_(step),
        sleeper_(problem_.sleeper, problem_.laws()) {}

  proto::Interface describe() override {
    proto::Interface interface;
    interface.fields = {{field::rail_displacement_begin, "m", 3, false},
                        {field::rail_displacement, "m", 3, false},
                        {field::joint_force_begin, "N", 3, false},
                        {field::joint_force, "N", 3, false},
                        {field::impulse, "N s", 3, true},
                        {field::pad_work, "J", 3, true},
                        {field::sleeper_displacement, "m", 3, true},
                        {field::sleeper_velocity, "m/s", 3, true}};
    for (const auto& seat : seats_) {
      auto r = registration(seat, cells_of(seat));
      for (int value = 0; value < 3 * seat.n_cells(); ++value) {
        const auto law = seat.cell_law(value % 3);
        r.stiffness.push_back(law.stiffness), r.damping.push_back(law.damping), r.preload.push_back(law.preload);
        r.tension_cutoff.push_back(law.tension_cutoff);
      }
      interface.seats.push_back(r);
    }
    return interface;
  }
  proto::Configured configure(const proto::Configure&) override { return {step_, {}, {}}; }
  proto::FieldSet start() override { return sleeper_.motion(); }

 private:
  coupler::Side& side() override { return sleeper_; }
  double step_;
  tests::LinearSleeper sleeper_;
};

}  // namespace

int main(int argc, char** argv) {
  using tests::option;
  try {
    const auto file = proto::CaseFile::load(option(argc, argv, "--case"));
    const auto seats = proto::read_rail_seats(file);
    const auto options = proto::read_session_options(option(argc, argv, "--endpoint"), file.hash());
    const auto name = option(argc, argv, "--name");
    auto problem = tests::linear_problem(option(argc, argv, "--problem"));
    std::unique_ptr<proto::Participant> side;
    if (option(argc, argv, "--side") == "rail")
      side = std::make_unique<Rail>(name, problem, seats, option(argc, argv, "--fault"));
    else
      side = std::make_unique<Sleeper>(name, problem, seats, std::stod(option(argc, argv, "--step")));
    proto::serve(*side, options);
    return 0;
  } catch (const proto::Error& error) {
    std::fprintf(stderr, "linear_participant: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
