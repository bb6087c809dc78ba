#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/interpretation/interpretation.h"
#include "ground/model/load_model.h"
#include "ground/renderer/layers.h"
#include "ground/renderer/temperature_scale.h"

namespace isotherm {

/// Holds what a saved model shows, whatever the view: the points that cloud.ply would have.
struct ModelSurface {
  std::vector<Eigen::Vector3f> points_m;   ///< In `world`.
  std::vector<float> celsius;              ///< As many; NaN = never measured, or not interpreted.
  std::vector<PartReport> interpretation;  ///< One per part; empty without an interpretation.
};
/// Temperatures stay apparent if `interpretation` is nullptr.
ModelSurface SurfaceOf(const LoadedModel& model, const GroundOptions& options,
                       const Interpretation* interpretation, ThreadPool& pool);

/// Renderings to be made of a model.
struct RenderingRequest {
  std::vector<RenderLayer> layers;
  std::vector<RigidTransform> views;  ///< T_world_camera.
  CameraModel camera;
  std::filesystem::path output;  ///< A .png if there is one rendering, else a folder that exists.
  const Interpretation* interpretation = nullptr;  ///< nullptr: temperatures stay apparent.
};

/// The files of a request, view by view: LAYER.png, or LAYER_000.png and so on for several views.
std::vector<std::filesystem::path> RenderingFiles(const RenderingRequest& request);

/// Creates the folder that the request's files go to. Refuses one file for several renderings.
Status PrepareRenderings(const RenderingRequest& request);

/// Casts the model from each view and writes its renderings, all in one scale. Returns how many
/// views show nothing of the model. `progress` is called with the fraction done, 0..1.
Result<int> WriteRenderings(const LoadedModel& model, const GroundOptions& options,
                            const std::optional<TemperatureScale>& scale,
                            const RenderingRequest& request, ThreadPool& pool,
                            const std::function<void(double fraction)>& progress);

}  // namespace isotherm
