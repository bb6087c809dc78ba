#pragma once

#include <cstdint>
#include <optional>

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/geometry/camera.h"
#include "ground/thermal/reading_corrections.h"
#include "ground/thermal/scene_influence_corrector.h"

namespace isotherm {

/// Removes lens distortion from thermal frames: °C per pixel of the ideal camera, which sees all
/// that the frame shows (RectifiedCamera); NaN outside the frame or where it has no value.
/// Before that it corrects the readings: takes out what the scene adds to each pixel, and adds the
/// radiometric correction. Bilinear. Keeps scratch memory.
/// Thread-compatible.
class ThermalRectifier {
 public:
  ThermalRectifier(const CameraModel& camera, const ReadingCorrections& corrections);
  /// `temperature_raw`, counts of `scale`, has the camera's size (CHECK). Writes into `celsius`
  /// with `apron` pixels of NaN all around. NaN is also what lies
  /// outside kMinRadiometric_celsius..kMaxRadiometric_celsius, which the model cannot hold.
  void Rectify(const Image<std::uint16_t>& temperature_raw, const RadiometricScale& scale,
               int apron, ThreadPool& pool, Image<float>& celsius);
  /// Per pixel of the ideal camera, the variance of what is uncorrelated noise in the frame, as a
  /// fraction of that in the frame: interpolation averages up to four pixels, and what takes the
  /// scene's influence out raises it. 0 outside.
  const Image<float>& noise_gain() const { return noise_gain_; }
  const CameraModel& camera() const { return camera_; }
  const CameraModel& ideal_camera() const { return ideal_; }

 private:
  CameraModel camera_;
  CameraModel ideal_;
  Image<std::int32_t> source_;  ///< Upper left of the four source pixels, -1 = outside.
  Image<float> fraction_x_, fraction_y_;
  Image<float> noise_gain_;
  Image<float> image_;  ///< The frame in °C.
  std::optional<SceneInfluenceCorrector> corrector_;
  const RadiometricCorrection radiometric_correction_;
};

}  // namespace isotherm
