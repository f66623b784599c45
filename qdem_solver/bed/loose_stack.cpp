#include "qdem_solver/bed/loose_stack.hpp"

#include <algorithm>
#include <string>

#include "proto/error.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

/// A stone turned at random and its box about the template's origin.
struct Turned {
  Eigen::Matrix3d rotation;
  Vector3d low, high;
  Vector3d size() const { return high - low; }
};

Turned turn(const Template& shape, double scale, double gap, Random& random) {
  Turned turned;
  turned.rotation = random.rotation();
  turned.low = turned.high = turned.rotation * (scale * shape.nodes[0]);
  for (const Vector3d& node : shape.nodes) {
    const Vector3d x = turned.rotation * (scale * node);
    turned.low = turned.low.cwiseMin(x), turned.high = turned.high.cwiseMax(x);
  }
  turned.low.array() -= gap, turned.high.array() += gap;
  return turned;
}

/// The place where the next box goes.
class Shelf {
 public:
  Shelf(const std::vector<Rectangle>& floor, double bottom) : floor_(floor), level_(bottom) { open(0); }

  /// Low corner of a box of `size`, or false when it fits into no rectangle.
  bool place(const Vector3d& size, Vector3d& low) {
    for (std::size_t tries = 0; tries <= 2 * floor_.size(); ++tries) {
      if (x_ + size[0] > floor_[at_].x1) x_ = floor_[at_].x0, y_ += row_, row_ = 0;
      if (x_ + size[0] <= floor_[at_].x1 && y_ + size[1] <= floor_[at_].y1) {
        low = {x_, y_, level_};
        x_ += size[0], row_ = std::max(row_, size[1]), height_ = std::max(height_, size[2]);
        return true;
      }
      next();
    }
    return false;
  }

 private:
  void open(std::size_t at) { at_ = at, x_ = floor_[at].x0, y_ = floor_[at].y0, row_ = 0; }
  void next() {
    if (at_ + 1 < floor_.size()) return open(at_ + 1);
    level_ += height_, height_ = 0;
    open(0);
  }

  const std::vector<Rectangle>& floor_;
  std::size_t at_ = 0;
  double level_, height_ = 0, x_ = 0, y_ = 0, row_ = 0;
};

}  // namespace

std::vector<Placement> stack_loosely(const std::vector<Template>& templates, const std::vector<Stone>& stones,
                                     const std::vector<double>& scales, const std::vector<Rectangle>& floor,
                                     double bottom, double gap, Random& random) {
  std::vector<Placement> places;
  Shelf shelf(floor, bottom);
  for (std::size_t i = 0; i < stones.size(); ++i) {
    const Turned turned = turn(templates[stones[i].template_id], scales[i], gap, random);
    Vector3d low;
    if (!shelf.place(turned.size(), low)) {
      throw proto::Error(proto::ExitCode::bad_data,
                         "a stone of " + std::to_string(stones[i].size) + " m is too large for the bed", "[bed]",
                         "widen the bed or choose smaller sieves");
    }
    places.push_back({turned.rotation, low - turned.low});
  }
  return places;
}

}  // namespace qdem::bed
