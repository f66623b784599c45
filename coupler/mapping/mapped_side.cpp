#include "coupler/mapping/mapped_side.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "proto/error.hpp"

namespace coupler {
namespace {

namespace field = proto::field;
constexpr double force_tolerance = 1e-9;  // of the largest value

/// The force that loads the rail when it is given; none in the mode robin.
std::vector<double> given_force(const proto::FieldSet& data) {
  if (data.has(field::force_mean)) return data.get(field::force_mean);
  if (!data.has(field::joint_force)) return {};
  auto force = data.get(field::joint_force);
  const auto& begin = data.get(field::joint_force_begin);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = (begin[i] + force[i]) / 2;
  return force;
}

void expect_equal(const std::vector<double>& found, const std::vector<double>& wanted, std::int64_t window) {
  double largest = 0.0, difference = found.size() == wanted.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(found.size(), wanted.size()); ++i) {
    largest = std::max(largest, std::abs(wanted[i]));
    difference = std::max(difference, std::abs(found[i] - wanted[i]));
  }
  if (difference <= force_tolerance * largest) return;
  throw proto::Error(proto::ExitCode::protocol, "fem was not loaded by the force it was given",
                     "window " + std::to_string(window), "force_used is the given force at its own points");
}

}  // namespace

proto::Advance at_points(const PadMap& map, proto::Advance request) {
  for (const char* name : {field::force_mean, field::joint_force_begin, field::joint_force})
    if (request.data.has(name)) request.data.set(name, map.to_points(request.data.get(name)));
  return request;
}

proto::FieldSet at_cells(const PadMap& map, proto::FieldSet motion) {
  for (const char* name : {field::rail_displacement, field::rail_velocity})
    if (motion.has(name)) motion.set(name, map.to_cells(motion.get(name)));
  return motion;
}

proto::Result at_cells(const PadMap& map, proto::Result result, const proto::Advance& request) {
  result.data = at_cells(map, std::move(result.data));
  const auto given = given_force(request.data);
  if (!given.empty() && result.data.has(field::force_used)) {
    expect_equal(result.data.get(field::force_used), map.to_points(given), request.window);
    result.data.set(field::force_used, given);
  }
  return result;
}

proto::Result MappedSide::advance(const proto::Advance& request) {
  return at_cells(map_, side_.advance(at_points(map_, request)), request);
}

void MappedSide::begin(const proto::Advance& request) {
  request_ = request;
  side_.begin(at_points(map_, request));
}

proto::Result MappedSide::end() {
  return at_cells(map_, side_.end(), request_);
}

}  // namespace coupler
