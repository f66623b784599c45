#include "qdem_solver/engine/cpu/blocks.hpp"

#include <algorithm>
#include <numeric>

namespace qdem::cpu {
namespace {

constexpr int group_size = 8;
constexpr int block_size = 768;  ///< elements at most: their particles' records and forces take 20 KB in a usual mesh

using Iterator = std::vector<int>::iterator;

/// Blocks of neighbouring elements: halves across the longest extent, again and again, nearly equal in the end.
class Bisection {
 public:
  Bisection(const ElementView& elements, const std::vector<Eigen::Vector3d>& nodes) : centres_(elements.n_elements) {
    for (int e = 0; e < elements.n_elements; ++e) {
      centres_[e].setZero();
      for (int k = 0; k < elements.n_particles; ++k) {
        centres_[e] += nodes[elements.particles[elements.n_particles * e + k]];
      }
    }
    std::vector<int> order(elements.n_elements);
    std::iota(order.begin(), order.end(), 0);
    cut(order.begin(), order.end());
  }

  std::vector<std::vector<int>> blocks;  ///< elements, ascending

 private:
  void cut(Iterator first, Iterator last) {
    const auto n = last - first, n_blocks = (n + block_size - 1) / block_size;
    if (n_blocks <= 1) {
      blocks.emplace_back(first, last);
      std::sort(blocks.back().begin(), blocks.back().end());
      return;
    }
    const int axis = longest_axis(first, last);
    const auto middle = first + n * (n_blocks / 2) / n_blocks / group_size * group_size;
    std::nth_element(first, middle, last, [&](int p, int q) {
      const double a = centres_[p][axis], b = centres_[q][axis];
      return a != b ? a < b : p < q;
    });
    cut(first, middle);
    cut(middle, last);
  }

  int longest_axis(Iterator first, Iterator last) const {
    Eigen::Vector3d low = centres_[*first], high = low;
    for (auto e = first; e != last; ++e) low = low.cwiseMin(centres_[*e]), high = high.cwiseMax(centres_[*e]);
    int axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
  }

  std::vector<Eigen::Vector3d> centres_;  ///< times the number of particles
};

/// Puts elements without common particles into eights: additions to one place wait for each other.
class Groups {
 public:
  explicit Groups(const ElementView& elements, int n_nodes) : elements_(elements), taken_in_(n_nodes, -1) {}

  std::vector<int> order(std::vector<int> left) {
    std::vector<int> result;
    while (!left.empty()) {
      ++group_;
      const std::size_t begin = result.size(), wanted = std::min<std::size_t>(group_size, left.size());
      const auto takes = [&](int e) { return result.size() < begin + wanted && take(e, result); };
      left.erase(std::remove_if(left.begin(), left.end(), takes), left.end());
      const std::size_t missing = begin + wanted - result.size();
      result.insert(result.end(), left.begin(), left.begin() + static_cast<std::ptrdiff_t>(missing));
      left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(missing));
    }
    return result;
  }

 private:
  bool take(int e, std::vector<int>& result) {
    const int* particles = elements_.particles + elements_.n_particles * e;
    const int* end = particles + elements_.n_particles;
    if (std::any_of(particles, end, [&](int node) { return taken_in_[node] == group_; })) return false;
    std::for_each(particles, end, [&](int node) { taken_in_[node] = group_; });
    result.push_back(e);
    return true;
  }

  const ElementView& elements_;
  std::vector<int> taken_in_;  ///< group that last took each particle
  int group_ = -1;
};

/// Writes one block after the other.
class BlockWriter {
 public:
  BlockWriter(const ElementView& elements, int n_nodes, ElementBlocks& out)
      : elements_(elements), out_(out), block_of_(n_nodes, -1), number_of_(n_nodes) {}

  void add(const std::vector<int>& elements) {
    const int n_groups = (static_cast<int>(elements.size()) + group_size - 1) / group_size;
    const int first_copy = static_cast<int>(out_.copies.size());
    for (int group = 0; group < n_groups; ++group) {
      for (int k = 0; k < elements_.n_particles; ++k) {
        for (int lane = 0; lane < group_size; ++lane) {
          out_.corners.push_back(
              number(elements_.particles[elements_.n_particles * at(elements, group, lane) + k], first_copy));
        }
      }
      for (int lane = 0; lane < group_size; ++lane) {
        const bool filler = group * group_size + lane >= static_cast<int>(elements.size());
        write_numbers(at(elements, group, lane), first_group_ + group, lane, filler);
      }
    }
    out_.blocks.push_back({first_group_, n_groups, first_copy, static_cast<int>(out_.copies.size()) - first_copy});
    first_group_ += n_groups;
  }

 private:
  static int at(const std::vector<int>& elements, int group, int lane) {
    return elements[std::min<std::size_t>(group * group_size + lane, elements.size() - 1)];
  }

  std::uint16_t number(int node, int first_copy) {
    const int block = static_cast<int>(out_.blocks.size());
    if (block_of_[node] != block) {
      block_of_[node] = block, number_of_[node] = static_cast<int>(out_.copies.size()) - first_copy;
      out_.copies.push_back(node);
    }
    return static_cast<std::uint16_t>(8 * number_of_[node]);
  }

  void write_numbers(int e, int group, int lane, bool filler) {
    const int n_shape = elements_.n_shape;
    double* numbers = out_.numbers.data() + group_size * (std::int64_t{group} * (n_shape + 1)) + lane;
    for (int i = 0; i < n_shape; ++i) numbers[group_size * i] = elements_.shapes[std::int64_t{n_shape} * e + i];
    numbers[group_size * n_shape] = filler ? 0.0 : elements_.weights[e];
  }

  const ElementView& elements_;
  ElementBlocks& out_;
  std::vector<int> block_of_, number_of_;  ///< of each node: the last block that has it, its number there
  int first_group_ = 0;
};
static_assert(8 * 4 * block_size < 65536, "numbers of particles in a block fit into 16 bits");

void add_node_copies(int n_nodes, ElementBlocks& out) {
  out.node_offsets.assign(n_nodes + 1, 0);
  for (const int node : out.copies) ++out.node_offsets[node + 1];
  std::partial_sum(out.node_offsets.begin(), out.node_offsets.end(), out.node_offsets.begin());
  std::vector<int> next(out.node_offsets.begin(), out.node_offsets.end() - 1);
  out.node_copies.resize(out.copies.size());
  for (int copy = 0; copy < static_cast<int>(out.copies.size()); ++copy)
    out.node_copies[next[out.copies[copy]]++] = copy;
}

}  // namespace

ElementBlocks make_blocks(const ElementView& elements, const std::vector<Eigen::Vector3d>& nodes) {
  ElementBlocks result;
  result.n_corners = elements.n_particles, result.n_values = elements.n_shape + 1;
  const int n_nodes = static_cast<int>(nodes.size());
  const Bisection bisection(elements, nodes);
  std::int64_t n_groups = 0;
  for (const auto& block : bisection.blocks) n_groups += (block.size() + group_size - 1) / group_size;
  result.numbers = AlignedValues(group_size * (elements.n_shape + 1) * n_groups);
  Groups groups(elements, n_nodes);
  BlockWriter writer(elements, n_nodes, result);
  for (const auto& block : bisection.blocks) writer.add(groups.order(block));
  add_node_copies(n_nodes, result);
  return result;
}

}  // namespace qdem::cpu
