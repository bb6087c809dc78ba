#pragma once

#include <atomic>
#include <string_view>

#include "edge/usb/testing/emulated_uvc_camera.h"

namespace isotherm {

/// An InfiRay P2 Pro at high speed: 256x384 words, of which the lower half is temperatures. Faults
/// besides those of EmulatedUvcCamera: `f:nuc` the image stands still and the shutter says so
/// when asked, `f:silent` it stands still and says nothing, `f:cold` all counts are 0x8000.
class EmulatedP2Pro final : public EmulatedUvcCamera {
 public:
  explicit EmulatedP2Pro(std::string_view script);
  /// One that streams over bulk transfers, in payloads of at most this many bytes.
  EmulatedP2Pro(std::string_view script, std::uint32_t bulk_payload_bytes);

  /// The value of pixel (0, 0) without noise, kelvin x 64; columns follow in steps of 1.
  static constexpr std::uint16_t kFirstCount = 18'560;  // 290 K.
  static constexpr int kNoise = 8;

  /// Thread-safe.
  int corrections() const { return corrections_; }
  int automatic() const { return automatic_; }    ///< -1 = never set.
  int emissivity() const { return emissivity_; }  ///< In 1/127; -1 = never set.
  int gain() const { return gain_; }              ///< 1 high, 0 low.

 protected:
  std::vector<std::uint8_t> MakeFrame(const FaultStep& step) override;
  std::optional<std::vector<std::uint8_t>> VendorControl(const UsbControl& control, Bytes data,
                                                         std::size_t read_bytes) override;

 private:
  void TakeCommand(std::uint16_t index, Bytes data);

  std::vector<std::uint8_t> frame_;
  std::vector<std::uint8_t> long_command_;
  std::uint32_t noise_ = 1;
  int busy_ = 0;  ///< Times that it still answers "busy".
  int ordered_frames_ = 0;
  bool closed_ = false;
  std::atomic<int> corrections_{0};
  std::atomic<int> automatic_{-1};
  std::atomic<int> emissivity_{-1};
  std::atomic<int> gain_{1};
};

}  // namespace isotherm
