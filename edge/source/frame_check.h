#pragma once

#include <array>
#include <cstdint>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/rig/rig.h"

namespace isotherm {

class FrameCheckOptions;

Status Validate(const FrameCheckOptions& options);

/// Refuses frames that cannot be what the camera saw, before anything uses them, and masks single
/// values: apparent temperatures out of range become 0 (no value), as do those at the end of the
/// frame's scale. Depth is left as it is: 0 and
/// 65535 already mean "no return". The expected size is the rig's, or that of the sensor's first
/// frame. Thread-compatible.
class FrameCheck {
 public:
  explicit FrameCheck(const FrameCheckOptions& options);

  /// Takes the expected sizes from the calibration.
  void Expect(const Rig& rig);
  /// Thermal frames hold counts instead of temperatures: nothing is masked.
  void KeepCounts(bool keep) { keep_counts_ = keep; }

  /// kDataLoss for a frame to be dropped; otherwise `frame` is masked and good.
  Status Process(RawFrame& frame);

  std::uint64_t masked_pixels() const { return masked_pixels_; }

 private:
  /// Holds the size of a stream's images, which must not change.
  struct Size {
    int width = 0;
    int height = 0;
  };
  void MaskTemperatures(const RadiometricScale& scale, Image<std::uint16_t>& temperature_raw);

  const double min_celsius_;
  const double max_celsius_;
  std::array<Size, 2> expected_{};  ///< By Sensor; zero = not known yet.
  bool keep_counts_ = false;
  std::uint64_t masked_pixels_ = 0;
};

}  // namespace isotherm
