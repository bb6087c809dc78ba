#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "edge/thermal_camera/thermal_camera.h"
#include "edge/usb/uvc_payload.h"

namespace isotherm {

/// Thermal Master P3 (256x192) and P1 (160x120) (jvdillon/p3-ir-camera, fasmide/thermalapp). A
/// frame is a marker, (2 x height + 2) rows of words, and an end marker in a transfer of its own.
/// A marker has the form of a UVC payload header with both time stamps.
struct P3Layout {
  int width = 0;
  int height = 0;

  std::size_t data_bytes() const {
    return 2 * static_cast<std::size_t>(width) * (2 * static_cast<std::size_t>(height) + 2);
  }
};

inline constexpr std::size_t kP3MarkerBytes = 12;

/// Ticks of a marker's time stamp per microsecond: 600 000 per frame of 40 ms.
inline constexpr std::uint64_t kP3TicksPerMicrosecond = 15;

/// Holds what is used of the rows below the image.
struct P3Metadata {
  std::uint16_t frame_counter = 0;  ///< Stands still while the camera corrects itself.
  bool correcting = false;
};

/// Holds an image and what the camera says about it.
struct P3Frame {
  Image<std::uint16_t> counts;
  P3Metadata metadata;
};

/// `data` is what lies between the markers; kDataLoss if it has the wrong size.
Result<P3Frame> ParseP3Frame(Bytes data, const P3Layout& layout);

/// Joins bulk transfers to frames, and finds the beginning of the next one after damage.
/// Thread-compatible.
class P3Assembler {
 public:
  explicit P3Assembler(const P3Layout& layout) : data_bytes_(layout.data_bytes()) {}

  void AddTransfer(Bytes bytes, const HostStamp& stamp);
  void NoteLost() { frame_.incomplete = in_frame_; }
  /// Returns the next frame: bytes between the markers, time stamp of the start marker.
  std::optional<UvcFrame> Pop() { return finished_.Pop(); }
  bool has_frame() const { return !finished_.empty(); }

 private:
  void Finish(const UvcPayloadHeader& end);
  /// Ends the frame, complete or not; Pop returns it.
  void Conclude();

  const std::size_t data_bytes_;
  UvcFrame frame_;
  bool in_frame_ = false;
  bool seen_a_frame_ = false;
  WaitingFrames finished_;
};

/// A command of 18 bytes with its check sum.
std::array<std::uint8_t, 18> PackP3Command(std::uint16_t type, std::uint16_t parameter,
                                           std::uint16_t reg, std::uint16_t answer_bytes);
/// Text of a register: up to the first zero.
std::string P3Text(Bytes bytes);

}  // namespace isotherm
