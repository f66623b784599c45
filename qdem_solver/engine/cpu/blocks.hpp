// Elements of a body that stands alone, cut into blocks that fit into the first cache with their particles.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "qdem_solver/engine/cpu/aligned_values.hpp"
#include "qdem_solver/engine/cpu/kernels.hpp"

namespace qdem::cpu {

/// A block holds neighbouring elements in groups of eight, no two of a group with a common particle where that can be
/// had, and its own numbering of their particles. Groups that the elements do not fill repeat one of them without
/// weight.
struct ElementBlocks {
  struct Block {
    int first_group, n_groups;
    int first_copy, n_copies;  ///< of particles
  };
  int n_corners = 0, n_values = 0;  ///< of an element: particles; shape and weight
  std::vector<Block> blocks;
  std::vector<std::uint16_t> corners;          ///< [group][corner][8]: 8 x number of the particle within its block
  AlignedValues numbers;                       ///< [group][value][8]: shape, then weight
  std::vector<int> copies;                     ///< node of each block's particles
  std::vector<int> node_offsets, node_copies;  ///< CSR: node -> its copies, ascending

  const std::uint16_t* corners_of(const Block& block) const { return &corners[8 * n_corners * block.first_group]; }
  const double* numbers_of(const Block& block) const { return numbers.data() + 8 * n_values * block.first_group; }
};

/// `nodes`: places of the particles, which decide what is neighbouring.
ElementBlocks make_blocks(const ElementView& elements, const std::vector<Eigen::Vector3d>& nodes);

}  // namespace qdem::cpu
