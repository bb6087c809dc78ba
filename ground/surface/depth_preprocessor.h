#pragma once

#include <array>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/rig/sensor_models.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {

inline constexpr int kPyramidLevels = 3;

/// A depth image made ready for tracking and integration. Depth camera coordinates, metres.
struct PreparedDepth {
  CameraModel camera;  ///< Full resolution, without distortion.
  /// Depth along z as it was measured, its bias corrected, 0 = no return; in an image full of
  /// holes, those are filled.
  Image<float> depth_m;
  std::array<SurfaceMaps, kPyramidLevels> maps;  ///< Level 0 is full resolution, each next is half.
  /// Standard deviation of depth at 1 m, metres; it grows with the square of the depth.
  float noise_at_1m = 0.0F;
  int valid_pixels = 0;  ///< Pixels of level 0 with a measured depth.
};

Status Validate(const PreprocessorOptions& options);
Status Validate(const PreprocessorExpertOptions& options);

/// Holds the depths of use, metres: those of the depth camera, or what the options say instead.
struct DepthRange {
  double min_m;
  double max_m;
};
DepthRange RangeOf(const PreprocessorOptions& options, const DepthSensorModel& sensor);

/// Fails if the options and the depth camera together leave no depth.
Status CheckRange(const PreprocessorOptions& options, const DepthSensorModel& sensor);

/// Algorithm 1, lines 2-3: range check, rectification, correction of the depth camera's bias,
/// bilateral filter, depth pyramid, vertex and normal maps. Before the filter, holes of an image
/// that is full of them are filled. Keeps its images, so a stream of equal frames allocates
/// nothing. Thread-compatible.
class DepthPreprocessor {
 public:
  DepthPreprocessor(const PreprocessorOptions& options, const CameraModel& depth_camera,
                    const DepthSensorModel& sensor);

  /// `frame` must have the camera's size (CHECK). The result stays valid until the next call.
  const PreparedDepth& Process(const DepthFrame& frame, ThreadPool& pool);

 private:
  void ToMetres(const DepthFrame& frame, ThreadPool& pool);
  /// Multiplies row `y` of prepared_.depth_m by what its pixels' distances are wrong by.
  void CorrectBias(int y);

  const PreprocessorOptions options_;
  const DepthRange range_;
  const double noise_at_1m_m_;
  const CameraModel camera_;
  Image<std::int32_t> rectification_;  ///< Source pixel index per rectified pixel, -1 = outside;
                                       ///< empty: no distortion.
  const std::vector<float> bias_distances_m_;
  /// Multipliers of rectified pixels at each distance, but for the first less those at the distance
  /// before; empty: no bias is known.
  std::vector<Image<float>> bias_steps_;
  Image<std::uint16_t> rectified_raw_;
  Image<float> filled_m_;
  std::array<Image<float>, kPyramidLevels> filtered_m_;
  PreparedDepth prepared_;
};

/// Returns whether the image is full of holes, as that of a camera that was registered to another
/// one is: many of its pixels lack a neighbour. Looks at a sample of the rows.
bool IsFullOfHoles(const Image<float>& depth_m);

/// Gives pixels without return the depth of the plane through those at most two pixels away, where
/// these lie around them on one surface. `max_step_ratio`: the largest difference in depth between
/// neighbouring pixels of a surface, as a fraction; `noise_at_1m` metres.
void FillHoles(const Image<float>& depth_m, float max_step_ratio, float noise_at_1m,
               ThreadPool& pool, Image<float>& filled_m);

/// Bilateral filter with a Gaussian over pixels and a compact biweight (1 - (d/tau)^2)^2 over
/// depth, tau growing with depth squared as the noise of a triangulating sensor does. 0 = no
/// return, in and out. `noise_at_1m` (metres) is the standard deviation over depth there.
void BilateralFilter(const Image<float>& depth_m, const PreprocessorExpertOptions& options,
                     double noise_at_1m, ThreadPool& pool, Image<float>& filtered_m);

/// Difference in depth between neighbouring pixels, as a fraction of the depth, on a surface whose
/// normal is turned away from the line of sight by `angle_deg`.
float StepPerPixel(const CameraModel& camera, double angle_deg);

/// Halves a depth image: mean of those of the 2x2 pixels that lie within `max_step_ratio` of the
/// nearest.
void HalveDepth(const Image<float>& depth_m, float max_step_ratio, ThreadPool& pool,
                Image<float>& half_m);

/// Says which neighbours of a pixel make its normal.
struct NormalRule {
  int reach_px = 1;             ///< Their distance.
  float max_step_ratio = 0.0F;  ///< Largest step per pixel on one surface, as a part of the depth.
  float noise_at_1m = 0.0F;     ///< Metres; grows with depth squared.
};

/// Vertices and normals in camera coordinates. Normals from central differences; NaN where a
/// neighbour is missing or on another surface, or where the surface bends there by more than a
/// slope and noise explain.
void MakeSurfaceMaps(const Image<float>& depth_m, const CameraModel& camera, const NormalRule& rule,
                     ThreadPool& pool, SurfaceMaps& maps);

}  // namespace isotherm
