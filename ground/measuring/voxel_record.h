#pragma once

#include "ground/interpretation/interpretation.h"
#include "ground/measuring/measuring.pb.h"
#include "ground/measuring/surface_probe.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

measuring::Vector3 ToMessage(const Eigen::Vector3f& vector);

/// The limits that a scan's measurements were assessed by, for saying which rule failed.
struct AssessmentLimits {
  ThermalOptions limits;  ///< CompleteLimits.
};

/// All that the model knows about a place. `interpretation` makes the object temperature; points
/// are in the coordinates of the model.
measuring::VoxelRecord RecordAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                const ProbeHit& hit, const Interpretation& interpretation,
                                const AssessmentLimits& limits);

/// "good", "acceptable", "bad" or "never".
std::string QualityName(MeasurementQuality quality);

}  // namespace isotherm
