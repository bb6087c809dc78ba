#pragma once

#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"
#include "ground/measuring/measuring.pb.h"
#include "ground/measuring/object_temperatures.h"
#include "ground/measuring/surface_probe.h"
#include "ground/measuring/surface_sum.h"
#include "ground/measuring/voxel_record.h"

namespace isotherm {

/// Holds what measuring depends on beside the model.
struct MeasuringOptions {
  SurfaceOptions surface;
  AssessmentLimits limits;
  InterpretationOptions interpretation;
};
/// Returns those of a scan; `sensor` is the rig's thermal camera.
MeasuringOptions MakeMeasuringOptions(const GroundOptions& options,
                                      const ThermalSensorModel& sensor);

/// Measures shapes on a model. The console and `isotherm measure` both call this: the same model
/// and the same shapes give the same bits. Valid while the model does not change.
/// Thread-compatible.
class ShapeMeasurer {
 public:
  /// `T_world_model` is where the volumes are: shapes are in `world`. The volumes must outlive it.
  ShapeMeasurer(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                const RigidTransform& T_world_model, const MeasuringOptions& options);

  /// The record where a ray in `world` meets the surface.
  measuring::VoxelRecord Pick(const measuring::Anchor& ray,
                              const measuring::ObjectParameters& parameters);
  /// One entry for each shape, in the same order.
  std::vector<measuring::MeasuredShape> Measure(const measuring::ShapeList& shapes);

 private:
  std::optional<ProbeHit> Find(const measuring::Anchor& anchor);
  measuring::VoxelRecord RecordOf(const ProbeHit& hit, const Interpretation& interpretation);
  measuring::Vector3 InWorld(const Eigen::Vector3d& p_model) const;
  measuring::MeasuredShape MeasureOne(const measuring::Shape& shape);
  void MeasurePlace(const measuring::Shape& shape, const Interpretation& interpretation,
                    measuring::MeasuredShape& measured);
  void MeasureLine(const measuring::Shape& shape, const Interpretation& interpretation,
                   measuring::MeasuredShape& measured);
  void MeasureArea(const measuring::Shape& shape, const Interpretation& interpretation,
                   measuring::MeasuredShape& measured);
  void MeasureDistance(const measuring::Shape& shape, measuring::MeasuredShape& measured);
  /// The hits of all anchors; sets the problem if one of them finds nothing.
  std::optional<std::vector<ProbeHit>> FindAll(const measuring::Shape& shape, std::size_t at_least,
                                               measuring::MeasuredShape& measured);
  void ToWorld(measuring::Statistics& statistics) const;
  void SetStatistics(const SurfaceSum& sum, measuring::MeasuredShape& measured) const;

  SurfaceProbe probe_;
  const RigidTransform T_world_model_;
  const RigidTransform T_model_world_;
  const MeasuringOptions options_;
  ObjectTemperatures temperatures_;
};

/// How far anchors look, metres.
inline constexpr double kAnchorReach_m = 30.0;

/// Refuses shapes that nothing can be measured by: wrong numbers of anchors, parameters out of
/// range, too long texts.
Status Validate(const measuring::Shape& shape);

}  // namespace isotherm
