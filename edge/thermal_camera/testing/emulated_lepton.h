#pragma once

#include <atomic>
#include <string_view>

#include "edge/usb/testing/emulated_uvc_camera.h"

namespace isotherm {

/// A FLIR Lepton 3.5 on a PureThermal board, at full speed: 160x120 pixels with telemetry. Its
/// image is noise about a ramp, so that no two are the same.
class EmulatedLepton final : public EmulatedUvcCamera {
 public:
  explicit EmulatedLepton(std::string_view script, std::string_view serial = "LEPTON-1");

  /// Centi-kelvin of pixel (0, 0) without noise; columns follow in steps of 1.
  static constexpr std::uint16_t kFirstCentikelvin = 29'000;
  static constexpr int kNoise = 8;  ///< Values 0..kNoise-1 are added.

  /// Frames that it has made. Thread-safe.
  int frames() const { return frames_; }
  /// Corrections that were ordered. Thread-safe.
  int corrections() const { return corrections_; }
  /// Mode of corrections: 0 manual, 1 automatic. Thread-safe.
  int ffc_mode() const { return ffc_mode_; }
  /// 0 high, 1 low. Thread-safe.
  int gain() const { return gain_; }
  /// From now on it acknowledges another gain and does not take it.
  void KeepGain() { keeps_gain_ = true; }

 protected:
  std::vector<std::uint8_t> MakeFrame(const FaultStep& step) override;
  std::optional<std::vector<std::uint8_t>> VendorControl(const UsbControl& control, Bytes data,
                                                         std::size_t read_bytes) override;

 private:
  std::vector<std::uint8_t> frame_;
  std::uint32_t counter_ = 0;
  std::uint32_t uptime_ms_ = 60'000;
  std::uint32_t uptime_at_ffc_ms_ = 1'000;
  std::uint32_t noise_ = 1;
  int ordered_frames_ = 0;  ///< Frames that an ordered correction still takes.
  std::atomic<int> frames_{0};
  std::atomic<int> corrections_{0};
  std::atomic<int> ffc_mode_{1};
  std::atomic<int> gain_{0};
  std::atomic<bool> keeps_gain_{false};
};

}  // namespace isotherm
