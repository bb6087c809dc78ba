#pragma once

#include <vector>

#include "common/simulation/scene.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

/// The part of a scene's true surface that an operator before it could measure well: some place
/// from which a point is seen at a good distance and angle is free and before the scene's front.
/// Points of a model are assessed by it, whatever the model knows.
class MeasurableSurface {
 public:
  /// `limits` come from CompleteLimits.
  MeasurableSurface(const Scene& scene, const ThermalOptions& limits);

  /// The fraction of it that some sub-map whose place is known has measured well, 0..1.
  double MeasuredWell(const ScanModel& model) const;
  const std::vector<Eigen::Vector3d>& points_world() const { return points_world_; }

 private:
  std::vector<Eigen::Vector3d> points_world_;  ///< Each for the same area.
};

}  // namespace isotherm
