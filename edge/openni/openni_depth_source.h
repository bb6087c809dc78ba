#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/time/clock.h"
#include "edge/openni/openni_device.h"
#include "edge/openni/tick_unwrapper.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/frame_source.h"
#include "edge/source/missed_frames.h"

namespace isotherm {

/// Frames of a depth camera through OpenNI2, or of an .oni file. Arrival is when the library hands
/// over the whole frame. The camera's own frame count becomes the frame number, so that frames lost
/// in the camera or the library leave holes; reopening goes on behind the last one.
///
/// Read fails when the camera was unplugged or no frame came for `stall_timeout_s`. The rig is
/// nominal: intrinsics from the field of view, nothing else. Thread-bound.
class OpenniDepthSource final : public FrameSource {
 public:
  /// `clock` must outlive the source. `file_rate`: how fast a file plays, as in SourceOptions.rate.
  OpenniDepthSource(const DepthCameraOptions& options, double file_rate, const Clock& clock);
  ~OpenniDepthSource() override;

  std::string_view name() const override { return "OpenNI2 depth camera"; }
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override { device_.reset(); }
  std::optional<Rig> rig() const override;
  std::vector<CameraDescription> cameras() const override;

 private:
  RawFrame ToRawFrame(OpenniDevice::Frame frame);
  std::uint64_t Number(int index);
  /// For files that do not play in real time: as if it had.
  void PlaceInTime(RawFrame& raw);
  Status CheckStall() const;

  const DepthCameraOptions options_;
  const double file_rate_;
  const Clock& clock_;
  std::unique_ptr<OpenniDevice> device_;  ///< Null: closed.
  TickUnwrapper unwrapper_;
  std::optional<MissedFrames> missed_;  ///< Since Open.
  std::uint64_t next_number_ = 0;
  SteadyTime last_frame_at_{};
  std::optional<CaptureTime> file_start_;
  DeviceTicks file_first_ticks_{};
};

}  // namespace isotherm
