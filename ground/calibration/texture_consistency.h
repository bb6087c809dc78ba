#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/geometry/stamped_pose.h"
#include "common/time/time_types.h"
#include "ground/calibration/delay_search.h"

namespace isotherm {

/// A point of the scanned surface.
struct TexturePoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< Metres.
  Eigen::Vector3d n_world = Eigen::Vector3d::Zero();  ///< Unit, towards the observer.
};

/// A thermal image with its stamp as the recording has it.
struct StampedThermal {
  CaptureTime time;
  /// As in ThermalFrame.
  std::shared_ptr<const Image<std::uint16_t>> temperature_raw;
  RadiometricScale scale{};
  /// Indices, ascending, of the points that it shows whatever its delay is within the range that
  /// is searched; empty if poses are missing there.
  std::vector<std::uint32_t> visible;
  std::uint8_t nuc_epoch = 0;  ///< NUCs of the session before it, modulo 256.
};

/// Holds what a scan offers for finding the delay of its thermal camera.
struct ScanViews {
  CameraModel thermal_camera;
  RigidTransform T_thermal_depth = RigidTransform::Identity();
  double delay_s = 0.0;  ///< To be added to the stamps; the delays that are tried are around it.
  std::vector<StampedPose> trajectory;  ///< By time.
  std::vector<TexturePoint> points;  ///< In random order, so that any number of the first will do.
  std::vector<StampedThermal> frames;  ///< By time.
  double row_readout_s = 0.0;          ///< As in ThermalSensorModel; stamps are of the middle row.
  double pose_drift_m = 0.0;  ///< Drift of the poses within seconds, one sigma along each axis.
};

/// Interpolated; nullopt outside the trajectory and in its gaps.
std::optional<RigidTransform> InterpolatePose(const std::vector<StampedPose>& trajectory,
                                              CaptureTime time);

/// Says which images are compared about a point: those of a part of the scan, so that what drifts
/// more slowly is the same for all of them, or those of the whole scan.
enum class ComparedImages : std::uint8_t { kOfPart, kOfScan };

/// Returns the length in seconds of the parts of a scan that are to be `part_s` long: longer if
/// they would be too many to hold enough images each.
double PartLength(const ScanViews& views, double part_s);

/// Projects thermal images onto the surface at poses that a delay puts them at, and measures how
/// much they disagree about each point: its variance over the compared images, relative to what
/// noise and half a pixel of misalignment would give there, so that hot edges do not outweigh
/// everything else. Samples and their weights are the same for all delays. Thread-compatible.
class TextureConsistency {
 public:
  /// `views` and `pool` must outlive it. The scan is resampled in parts of `part_s` seconds (see
  /// PartLength).
  TextureConsistency(const ScanViews& views, double part_s, ComparedImages compared,
                     ThreadPool& pool);

  /// Weighs points by what they show at this delay; by delay 0 to begin with.
  void WeighAt(double delay_s);

  /// The number of parts of the scan with samples in them.
  int parts() const { return static_cast<int>(parts_.size()); }

  /// Mean weighted variance by resampling, with the first `points` of the points.
  std::vector<double> Measure(double delay_s, std::size_t points,
                              const std::vector<PartWeights>& resamplings) const;

 private:
  /// Sums what the images of one part of the scan show of one point.
  struct PointSums {
    double count = 0.0, value = 0.0, squares = 0.0, gradient = 0.0;
  };

  std::vector<double> VarianceWithinParts(const std::vector<std::vector<PointSums>>& parts,
                                          const std::vector<PartWeights>& resamplings) const;
  std::vector<double> VarianceOverScan(const std::vector<std::vector<PointSums>>& parts,
                                       const std::vector<PartWeights>& resamplings) const;
  std::vector<PointSums> MeasurePart(const std::vector<std::size_t>& frames, double delay_s,
                                     std::size_t points) const;
  std::vector<std::vector<PointSums>> MeasureParts(double delay_s, std::size_t points) const;
  void MakeParts(double part_s);

  const ScanViews& views_;
  const ComparedImages compared_;
  ThreadPool& pool_;
  std::vector<std::vector<std::size_t>> parts_;  ///< Indices of frames.
  std::vector<double> weights_;                  ///< By point, 1/K^2; 0 = seen too rarely.
  std::vector<double> means_celsius_;            ///< By point, where weighed: keeps the sums small.
};

}  // namespace isotherm
