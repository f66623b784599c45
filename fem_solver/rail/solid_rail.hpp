// The rail of solid elements.
#pragma once

#include <memory>
#include <vector>

#include "fem_solver/contact/head_band.hpp"
#include "fem_solver/rail/rail_model.hpp"

namespace fem {

/// Quadratic hexahedra; see rail_mesh.hpp, rail_system.hpp and head_band.hpp.
class SolidRail : public RailModel {
 public:
  SolidRail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner);

  const RailSystem& track() const override { return system_; }
  const RailMesh& kinematics() const override { return *system_.mesh; }
  const HeadBand& band() const override { return band_; }
  RailFigures figures() const override;

  /// Head under its own patch minus cross-section mean under a load spread over that cross-section, averaged over the
  /// stations of the middle bay. May be negative: a long patch on coarse elements hides deflection.
  double indentation(const Flexibility& flexibility) const override;

  /// Hexahedra between the elements' corner nodes.
  RailShape shape() const override;
  std::vector<RailField> fields() const override;

 private:
  Eigen::VectorXd section_load(int plane) const;

  Material material_;
  RailSystem system_;
  HeadBand band_;
  std::vector<int> corner_nodes_;  // ascending: node of the mesh for each point of the shape
};

/// A RailBuilder.
std::unique_ptr<RailModel> build_solid_rail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats,
                                            SeatOwner owner);

}  // namespace fem
