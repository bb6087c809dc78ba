#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/recording/recording.h"
#include "common/rig/rig.h"
#include "common/simulation/depth_sensor.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulated_clock.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/thermal_sensor.h"

namespace isotherm {

/// A whole scan: scene, path, rig, clocks and shutter. Knows the true time and pose of every frame
/// and renders any of them in any order with the same result. Thread-safe (immutable); scratch
/// memory is the caller's.
class SimulatedScan {
 public:
  /// Fails if the options are out of range or the rig file cannot be used.
  static Result<std::unique_ptr<SimulatedScan>> Create(const SimulationOptions& options);
  /// The same with a scene of the caller's own; `options.scene` does not matter then.
  static Result<std::unique_ptr<SimulatedScan>> Create(const SimulationOptions& options,
                                                       StagedScene staged);
  ~SimulatedScan();

  /// Keeps buffers from one image to the next; one for each thread that renders.
  struct Scratch {
    DepthSensor::Scratch depth;
    ThermalSensor::Scratch thermal;
  };

  const Rig& rig() const { return rig_; }
  const Scene& scene() const { return staged_.scene; }
  const BandRadiance& band() const { return thermal_sensor_.band(); }
  /// True exposure, device ticks and arrival of each frame, by frame number.
  const std::vector<SimulatedFrameTime>& depth_times() const { return depth_times_; }
  const std::vector<SimulatedFrameTime>& thermal_times() const { return thermal_times_; }
  /// Returns when the shutter was closed, within the scan.
  const std::vector<NucEvent>& nuc_events() const { return nuc_events_; }
  bool IsShutterClosed(CaptureTime time) const;
  /// The shutter's last opening before `time`, if it was closed before.
  std::optional<CaptureTime> LastOpening(CaptureTime time) const;

  /// Returns how much too warm an open shutter's image is at `time`, because the housing changed
  /// since the last correction.
  double DriftErrorKelvin(CaptureTime time) const;

  /// Returns how much too long the depth camera shows distances at `time`, as a factor.
  double DepthStretch(CaptureTime time) const;

  /// True T_world_depth.
  RigidTransform PoseAt(CaptureTime time) const;
  /// True T_world_thermal.
  RigidTransform ThermalPoseAt(CaptureTime time) const;

  RawFrame RenderDepth(std::uint64_t frame_number, Scratch& scratch) const;
  RawFrame RenderThermal(std::uint64_t frame_number, Scratch& scratch) const;

 private:
  SimulatedScan(const SimulationOptions& resolved, const Rig& rig, StagedScene staged);
  void ScheduleFrames();
  void ScheduleShutter();
  /// So many seconds after the start.
  double HousingCelsius(double seconds) const;
  /// Returns when the housing has changed by the shutter's drift_k since `after_s`, both in seconds
  /// after the start.
  double NextDrift(double after_s) const;
  /// Returns when the last correction before `time` ended, or 0: seconds after the start.
  double CorrectedAfter(CaptureTime time) const;
  Image<std::uint16_t> ThermalPixels(std::uint64_t frame_number, Scratch& scratch) const;
  /// Adds what a real camera shows beside its noise: pattern, flicker, drift of the housing.
  void AddErrors(CaptureTime time, Image<std::uint16_t>& temperature_raw) const;
  ThermalHousekeeping HousekeepingAt(CaptureTime time) const;

  const SimulationOptions options_;
  const Rig rig_;
  const StagedScene staged_;
  const DepthSensor depth_sensor_;
  const ThermalSensor thermal_sensor_;
  const CaptureTime start_;
  std::vector<SimulatedFrameTime> depth_times_;
  std::vector<SimulatedFrameTime> thermal_times_;
  std::vector<NucEvent> nuc_events_;
};

}  // namespace isotherm
