#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/time/clock.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/frame_source.h"
#include "edge/thermal_camera/camera_registry.h"
#include "edge/thermal_camera/frame_novelty.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

/// The thermal camera of this computer that the options ask for. `clock` must outlive it.
std::unique_ptr<FrameSource> MakeThermalCameraSource(const ThermalCameraOptions& options,
                                                     const Clock& clock);

/// Holds what became of the camera's frames since the start. All that came are in one of them.
struct ThermalCameraCounts {
  std::uint64_t delivered = 0;   ///< Including `frozen`.
  std::uint64_t frozen = 0;      ///< Delivered as taken behind a closed shutter.
  std::uint64_t repeated = 0;    ///< Sent again by the camera; left out.
  std::uint64_t incomplete = 0;  ///< Refused.
  /// Counted by the camera, never seen here; if it does not count, what was not read in time.
  std::uint64_t lost = 0;
};

/// Frames of one thermal camera as temperatures; in counts if it measures none and the options do
/// not say what counts mean (CameraDescription::counts_only).
///
/// - Temperatures are centi-kelvin, or in the scale that the camera's range needs. It is decided
///   when the camera is opened first: that is what the rig's description announces.
/// - Repeated images are left out; they are no loss.
/// - Frozen images count as taken behind a closed shutter; when they last, the camera is taken
///   for hung, as it is when nothing comes at all: Read fails, so that it is opened again.
/// - Incomplete frames come without pixels, so that whoever checks frames refuses and counts them.
/// - Frame numbers have holes where the camera counted images that never came.
/// - After it was opened once, a camera with another serial number is refused.
///
/// Thread-bound.
class ThermalCameraSource final : public FrameSource {
 public:
  /// Finds the cameras and makes drivers: the real ones, or those of a test.
  struct Cameras {
    std::function<Result<std::vector<DeviceDescription>>()> list;
    std::function<std::unique_ptr<ThermalCamera>(const DeviceDescription&)> make;
  };

  ThermalCameraSource(const ThermalCameraOptions& options, const Clock& clock, Cameras cameras);
  ~ThermalCameraSource() override;

  std::string_view name() const override { return name_; }
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override;
  /// Is not restarted by itself: SupervisedSource closes and opens it.
  std::optional<Status> Control(const CameraControl& control) override;
  std::vector<CameraDescription> cameras() const override;

  const ThermalCameraCounts& counts() const { return counts_; }

 private:
  Result<SourceItem> Check(RawThermalFrame raw);
  /// Returns a frame that is refused and counted further on, but has its number.
  RawFrame WithoutPixels(RawThermalFrame raw, std::string_view what);
  RawFrame Convert(const RawThermalFrame& raw);
  /// `what` and how long it has lasted, as a failure.
  Status Hangs(const std::string& what, Nanoseconds duration) const;
  /// Takes the temperatures of counts from the options if the camera does not know them.
  PixelEncoding EncodingOf(const RawThermalFrame& raw) const;
  /// Returns the scale for the range of the camera, or for the counts that the options explain.
  Result<RadiometricScale> ChooseScale() const;
  void UpdateTable(const PixelEncoding& encoding);

  const ThermalCameraOptions options_;
  const Clock& clock_;
  const Cameras cameras_;
  std::string name_ = "thermal camera";
  std::string serial_;  ///< Serial number of the camera that was opened first.
  std::unique_ptr<ThermalCamera> camera_;
  std::optional<FrameNovelty> novelty_;
  PixelEncoding encoding_;
  std::optional<RadiometricScale> scale_;    ///< Scale of the frames; nullopt = never opened.
  std::vector<std::uint16_t> raw_of_count_;  ///< 65536 values; 0 = no value.
  SteadyTime last_frame_at_{};
  std::uint64_t next_frame_number_ = 0;
  bool frozen_ = false;
  bool told_temperatures_ = false;      ///< By a frame since it was opened.
  bool incomplete_ = false;             ///< The last frame was incomplete.
  std::uint64_t incomplete_since_ = 0;  ///< Since the last whole frame.
  ThermalCameraCounts counts_;
};

}  // namespace isotherm
