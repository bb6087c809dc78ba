#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

class ThreadPool;

/// One point of the extended point cloud (algorithm 10).
struct CloudPoint {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  ///< In `world`.
  Eigen::Vector3f normal =
      Eigen::Vector3f::Zero();  ///< Unit, in `world`, towards the side it was observed from.
  float celsius = NAN;          ///< Apparent temperature, or the object's; NaN = none.
  std::uint8_t distance_class = kNeverMeasured;
  std::uint8_t angle_class = kNeverMeasured;
  std::uint8_t motion_class = kNeverMeasured;
  std::uint8_t disagreement_class = kNeverMeasured;
  // Of the measurement; empty or NaN without a temperature or without records.
  std::uint8_t nuc_epoch = 0;   ///< NUCs before it, modulo 256.
  std::uint8_t good_count = 0;  ///< Measurements under good conditions, up to 63.
  float nuc_age_s = NAN;
  float measured_distance_m = NAN;
  float measured_angle_deg = NAN;  ///< To the surface as it is now.
  float sigma_k = NAN;             ///< Standard uncertainty of `celsius`; NaN = not known.
  float apparent_celsius = NAN;    ///< Kept by Interpretation; NaN = never measured.
};

/// The zero crossings of the model, and triangles between them. Points that no triangle uses are
/// surface that lacks observed neighbours; they belong to the cloud, not to the mesh.
struct Surface {
  std::vector<CloudPoint> points;
  std::vector<Eigen::Vector3i>
      triangles;  ///< Indices of points, counter-clockwise seen from outside.

  /// The triangles with only the points that they use, in the same order.
  Surface MeshOnly() const;
};

/// Says which zero crossings of the distance are surface.
struct SurfaceOptions {
  /// Least weight of a voxel that becomes part of the surface.
  float min_weight = 2.0F;
  /// Where free space touches what lies unseen behind an edge, the distance changes sign as well,
  /// but faster than any distance to a surface can. Crossings where it changes by more than this
  /// many voxel sizes per voxel, along the edge or along the normal to either side, are left out. A
  /// distance field without noise has slope 1.
  float max_slope = 3.0F;
  /// Left out likewise: crossings where the gradients at the two ends of the edge point apart by
  /// more than this cosine (0.8: 37 degrees). -1 turns the test off.
  float min_gradient_cosine = 0.8F;
  bool triangles = true;
};

/// Finds every edge between neighbouring voxels on which the distance changes sign, and joins them
/// to triangles (marching cubes) that share points across blocks. Blocks in parallel; order and
/// values depend neither on the number of threads nor on the order in which blocks were allocated.
Surface ExtractSurface(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                       const SurfaceOptions& options, ThreadPool& threads);

}  // namespace isotherm
