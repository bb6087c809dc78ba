#pragma once

#include <Eigen/Core>
#include <vector>

#include "ground/evaluation/surface_evaluation.h"
#include "ground/mesh/surface.h"
#include "ground/pipeline/ground_pipeline.h"

namespace isotherm::testing {

/// Compares all of the surface that a pipeline has reconstructed so far with the truth.
inline SurfaceErrors CheckSurface(GroundPipeline& pipeline, const TrueSurface& truth) {
  SurfaceOptions options;
  options.min_weight = 1.0F;
  options.triangles = false;
  std::vector<Eigen::Vector3f> cloud;
  for (const CloudPoint& point : ExtractSurface(pipeline.model().tsdf(), pipeline.model().thermal(),
                                                options, pipeline.model().pool)
                                     .points) {
    cloud.push_back(point.position_m);
  }
  return EvaluateSurface(cloud, truth, {});
}

}  // namespace isotherm::testing
