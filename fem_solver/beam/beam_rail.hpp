// The rail as a Timoshenko beam.
#pragma once

#include <memory>
#include <vector>

#include "fem_solver/beam/beam_element.hpp"
#include "fem_solver/contact/running_band.hpp"
#include "fem_solver/rail/rail_model.hpp"

namespace fem {

/// Equal elements along the centroid of the profile. Degree of freedom 6 n + c is component c (displacement x, y, z,
/// rotation about x, y, z) of node n. Points off the axis follow their cross-section, which stays plane.
class BeamKinematics : public RailKinematics {
 public:
  /// `planes`: of the nodes; `lateral`: y of the section's plane of symmetry [m]. The foot's bottom face lies at z = 0.
  BeamKinematics(const RailSection& section, const Material& material, const RailPlanes& planes, double lateral);

  int n_dofs() const override { return 6 * n_nodes(); }
  /// Throws proto::Error (bad_data) for a point beyond the ends or outside of the profile.
  std::vector<MotionWeight> motion_at(const Eigen::Vector3d& point) const override;
  Eigen::MatrixXd rigid_motions(const Eigen::Vector3d& centre) const override;

  int n_nodes() const { return static_cast<int>(planes_.x.size()); }
  int n_elements() const { return n_nodes() - 1; }
  const RailPlanes& planes() const { return planes_; }
  const RailSection& section() const { return section_; }
  const BeamElement& element() const { return element_; }
  Eigen::Vector3d node(int n) const { return {planes_.x[n], lateral_, centroid_height_}; }

 private:
  RailSection section_;
  RailPlanes planes_;
  double lateral_, centroid_height_;
  BeamElement element_;
};

/// Stations are deflection and rotation of the nodes: a force at a place goes to the element's ends by its shape
/// functions. The deflection of the place against its element's ends is the missing flexibility.
class BeamBand : public RunningBand {
 public:
  /// `n_dofs`: of the track.
  BeamBand(const BeamKinematics& beam, int n_dofs);
  BandWeights at(double x) const override;

 private:
  const BeamKinematics& beam_;
};

/// A RailModel of few unknowns: consistent mass with rotary inertia, the same seats, pads and ends as the solid one.
class BeamRail : public RailModel {
 public:
  BeamRail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner);

  const TrackSystem& track() const override { return track_; }
  const BeamKinematics& kinematics() const override { return beam_; }
  const BeamBand& band() const override { return band_; }
  RailFigures figures() const override;
  /// A beam has no local flattening.
  double indentation(const Flexibility&) const override { return 0.0; }
  /// Lines along the centroid.
  RailShape shape() const override;
  std::vector<RailField> fields() const override;

 private:
  std::vector<double> at_nodes(const Eigen::VectorXd& field, int first) const;
  std::vector<double> section_forces(const Eigen::VectorXd& displacement, int strain) const;

  BeamKinematics beam_;
  TrackSystem track_;
  BeamBand band_;
};

/// A RailBuilder.
std::unique_ptr<RailModel> build_beam_rail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats,
                                           SeatOwner owner);

}  // namespace fem
