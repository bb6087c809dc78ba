#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "edge/source/frame_source.h"

namespace isotherm {

/// A camera pair that does what a script says. Steps are separated by blanks:
/// `[count*]what[:fault]`.
///
///   d  t      a depth or thermal frame (8x6 and 6x4 pixels; 30 and 40 Hz; arrival = kFakeEpoch +
///   device time)
///   p         an odometry pose, true when the next depth frame arrives
///   -         nothing yet
///   %         Read does not come back until Release()
///   !         Read fails (the cable came off)
///   d:empty   the frame has no pixels             d:size    ... the wrong size
///   d:reset   the camera's counter starts again   t:shut    the shutter is closed
///   t:hot     every other pixel is out of range   d:holes   every other pixel is 0 or 65535
///   t:same    the image before once more        d:lost    three numbers are missing before it
///   d:left    ... because its frames were left out (TakeLeftOut)
///
/// At the end of the script the stream ends. Opening again goes on with the script. Thread-bound.
class FakeSource final : public FrameSource {
 public:
  static constexpr CaptureTime kFakeEpoch{std::chrono::seconds(1'700'000'000)};
  static constexpr std::uint16_t kDepthRaw = 700;
  static constexpr std::uint16_t kCentikelvin = 29'815;

  explicit FakeSource(std::string_view script);

  std::string_view name() const override { return "fake"; }
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override {
    open_ = false;
    left_out_[0] += std::exchange(left_out_at_close, 0);
  }
  /// Answers with `control_answer`, at once or this many reads later.
  std::optional<Status> Control(const CameraControl& control) override;
  std::vector<ControlAnswer> TakeControlAnswers() override;
  std::array<std::uint64_t, 2> TakeLeftOut() override { return std::exchange(left_out_, {}); }

  std::vector<CameraDescription> cameras() const override { return descriptions; }

  /// It says of itself that it is a thermal camera.
  void DescribeThermal(bool counts_only) {
    CameraDescription camera;
    camera.sensor = Sensor::kThermal;
    camera.driver = "fake";
    camera.counts_only = counts_only;
    descriptions = {camera};
  }

  RadiometricScale thermal_scale;               ///< Scale of its thermal frames.
  std::vector<CameraDescription> descriptions;  ///< The source describes itself so.
  std::vector<CameraControl> controls;          ///< Orders that it was given.
  Status control_answer = FailedPrecondition("the source has no shutter to command");
  int answers_after_reads = 0;  ///< 0: at once.
  /// Depth frames of which only the end tells that they were left out.
  std::uint64_t left_out_at_close = 0;

  /// The next calls of Open fail, this many of them.
  void FailToOpen(int times) { failures_to_open_ = times; }
  int opened() const { return opened_; }

  /// Thread-safe: whether it is at a '%', and its end.
  bool hangs() const { return hangs_; }
  void Release() {
    released_ = true;
    released_.notify_all();
  }

 private:
  /// Holds one letter of the script.
  struct Step {
    char what = '-';
    std::string fault;
  };
  RawFrame MakeFrame(const Step& step);
  ExternalOdometry MakePose() const;

  std::vector<Step> steps_;
  std::size_t next_ = 0;
  std::size_t reads_ = 0;
  /// Holds an order that the camera has not answered yet.
  struct OpenOrder {
    CameraControl control;
    std::size_t answered_at;  ///< Index in `reads_`.
  };
  std::deque<OpenOrder> open_orders_;
  bool open_ = false;
  std::atomic<bool> hangs_{false};
  std::atomic<bool> released_{false};
  int opened_ = 0;
  int failures_to_open_ = 0;
  std::uint64_t frames_[2] = {};
  std::array<std::uint64_t, 2> left_out_{};
  std::uint16_t noise_ = 0;  ///< In one pixel of the newest thermal image.
  std::chrono::microseconds device_zero_[2] = {};
};

}  // namespace isotherm
