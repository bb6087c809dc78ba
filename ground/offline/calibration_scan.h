#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

class GroundOptions;
class GroundPipeline;
struct ScanModel;

/// Keeps what a recording offers for calibrating its thermal camera: the valid thermal frames, and
/// the pipeline that tracked the depth camera with the surface that it reconstructed.
/// Thread-compatible.
class TrackedRecording {
 public:
  /// Tracks the depth camera through a recording. Fails with what is missing: calibration, depth,
  /// thermal frames, poses. `progress` gets the fraction done, 0..1.
  /// `rig` replaces the recording's own calibration.
  static Result<TrackedRecording> Read(const std::filesystem::path& recording,
                                       const std::optional<Rig>& rig, const GroundOptions& options,
                                       const std::function<void(double)>& progress);
  ~TrackedRecording();
  TrackedRecording(TrackedRecording&&) noexcept;

  const Rig& rig() const { return rig_; }  ///< The one it was read with.
  /// Raw units per metre that replace those of the frames; nullopt: the frames' own hold.
  std::optional<double> depth_scale() const { return depth_scale_; }
  /// See AppliedDelay.
  std::optional<double> applied_delay_s() const { return applied_delay_s_; }
  ScanModel model() const;
  /// The valid thermal frames, by time; of a long scan some.
  const std::vector<StampedThermal>& frames() const { return frames_; }

 private:
  TrackedRecording() = default;

  Rig rig_;
  std::optional<double> depth_scale_;
  std::optional<double> applied_delay_s_;
  std::unique_ptr<GroundPipeline> pipeline_;
  std::vector<StampedThermal> frames_;
};

/// Holds what a recording offers for finding the delay of its thermal camera.
struct ScanForCalibration {
  ScanViews views;
  Rig rig;                                ///< As recorded.
  std::optional<double> applied_delay_s;  ///< See AppliedDelay.
};

/// The delay that stamps contain: what the recording says of it (AppliedDelay), else that of the
/// calibration that the edge used, if that is known. Fails if neither is.
Result<double> DelayInStamps(std::optional<double> applied_delay_s, const std::optional<Rig>& used);

/// Tracks the depth camera through a recording and takes a sample of the surface and of the valid
/// thermal frames, and which points they show at all delays in [-range_s, range_s]. Fails with what
/// is missing: calibration, depth, thermal frames, poses, motion. `progress` gets the fraction
/// done, 0..1.
Result<ScanForCalibration> ReadScan(const std::filesystem::path& recording,
                                    const GroundOptions& options, double range_s,
                                    const std::function<void(double)>& progress);

}  // namespace isotherm
