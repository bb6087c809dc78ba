#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Names the sensor of a frame. The values are part of recordings and of the wire.
enum class Sensor : std::uint8_t { kDepth = 0, kThermal = 1 };

/// Says where the knowledge about the shutter comes from.
enum class NucSource : std::uint8_t {
  kUnknown = 0,
  kInBand = 1,
  kPolled = 2,
  kCommanded = 3,
  kInferred = 4
};

/// Non-uniformity correction of the thermal camera (thesis 3.2.3). A fresh camera is kUnknown.
enum class NucState : std::uint8_t {
  kUnknown = 0,
  kIdle = 1,        ///< Corrected and settled: temperatures are valid.
  kDesired = 2,     ///< Due by drift or interval, still valid.
  kImminent = 3,    ///< About to start.
  kInProgress = 4,  ///< Shutter closed.
  kSettling = 5,    ///< Shutter open again, temperatures not yet trusted.
  kBlocked = 6,
  kError = 7,
};

inline constexpr float kUnknown_celsius = std::numeric_limits<float>::quiet_NaN();

/// Camera temperatures, °C, NaN = the camera does not say.
struct ThermalHousekeeping {
  float fpa_celsius = kUnknown_celsius;
  float housing_celsius = kUnknown_celsius;
  float shutter_celsius = kUnknown_celsius;
};

/// Holds what identifies a frame and its times, from the edge to the end.
struct FrameHeader {
  std::uint64_t session = 0;  ///< One per start of a scan on the edge.
  std::uint64_t frame_number =
      0;  ///< The edge's source counts, from 0 per session, what it delivers or knows to be lost.
  DeviceTicks device_ticks{};    ///< The camera's own stamp.
  CaptureTime capture_time{};    ///< Middle of the exposure, edge wall clock.
  Nanoseconds capture_sigma{0};  ///< One-sigma uncertainty of capture_time; 0 = not estimated.
};

/// Raw value of a depth pixel without a return; 65535 means the same (PrimeSense recorders write
/// both).
inline constexpr std::uint16_t kNoDepth = 0;
inline constexpr std::uint16_t kNoDepthSaturated = 65535;

/// Holds one depth image. Depth is along the optical axis (z), not along the line of sight. Frames
/// are shared between threads and never changed once they have left their source.
struct DepthFrame {
  FrameHeader header;
  Image<std::uint16_t> depth_raw;  ///< height x width, row-major, `depth_scale` units per metre
                                   ///< along z; 0 and 65535 = no return.
  double depth_scale = 1000.0;     ///< Raw units per metre.
};

/// Holds one thermal image: apparent temperatures, that is of a black body with the same radiance;
/// emissivity and reflections are corrected on the ground. Frames are shared between threads and
/// never changed once they have left their source.
struct ThermalFrame {
  FrameHeader header;
  Image<std::uint16_t> temperature_raw;  ///< height x width, row-major, apparent temperature in
                                         ///< counts of `scale`; 0 = no value.
  RadiometricScale scale{};
  NucState nuc_state = NucState::kUnknown;
  NucSource nuc_source = NucSource::kUnknown;
  std::optional<double>
      seconds_since_nuc;  ///< Since the shutter opened; nullopt = none in this session.
  ThermalHousekeeping housekeeping;
  bool valid = false;  ///< Temperatures may reach the model.
};

/// Holds what a thermal camera itself says of its correction.
struct CameraNuc {
  NucState state = NucState::kUnknown;
  NucSource source = NucSource::kUnknown;  ///< How the driver knows.
  std::optional<double> seconds_since;     ///< Since the last correction, by the camera's count.
};

/// Holds what a FrameSource delivers: pixels and times as the device and the host gave them, not
/// yet stamped.
struct RawFrame {
  Sensor sensor = Sensor::kDepth;
  std::uint64_t frame_number =
      0;  ///< Counted by the source; a hole is a frame that was lost before us.
  DeviceTicks device_ticks{};    ///< Unwrapped by the driver; backwards = the counter was reset.
  bool has_device_clock = true;  ///< False: the camera has no counter, and ticks mean nothing.
  /// The first one after its camera was opened again: its counter is another one, although its
  /// value may look as if the old one had gone on.
  bool reopened = false;
  CaptureTime arrival_wall{};  ///< Edge wall clock when the first byte reached us.
  /// This computer's monotonic clock at the same moment; 0 = the source does not say.
  SteadyTime arrival_steady{};
  Image<std::uint16_t> pixels;       ///< As DepthFrame::depth_raw or ThermalFrame::temperature_raw.
  double depth_scale = 1000.0;       ///< Raw depth units per metre (depth only).
  RadiometricScale thermal_scale{};  ///< Scale of the pixels (thermal only).
  bool shutter_closed = false;       ///< Thermal only: the camera says so (in band).
  /// Thermal only: more than the shutter flag; nullopt = the camera says nothing.
  std::optional<CameraNuc> camera_nuc;
  ThermalHousekeeping housekeeping;
};

/// The ways to pack an image. Values are on the wire and in recordings: never reuse one.
enum class Encoding : std::uint8_t {
  kRaw16 = 0,  ///< Little-endian 16-bit samples, row-major.
  kPng16 = 1,  ///< PNG, 16-bit grey.
  /// Ranks of the values that occur, predicted, entropy coded in two halves (common/codec). Read,
  /// no longer written.
  kDepthRans = 2,
  /// Values predicted by the median edge detector, entropy coded in two halves. Read, no longer
  /// written.
  kThermalRans = 3,
  /// As kRaw16, of a camera that measures no temperatures: its counts. A value of its own, so that
  /// nobody takes counts for centi-kelvin; programs that do not know it refuse the frame.
  kCounts16 = 4,
  /// Packed as kThermalRans and kRaw16, in the frame's own scale instead of centi-kelvin. They have
  /// values of their own for the same reason.
  kScaledThermalRans = 5,
  kScaledRaw16 = 6,
  /// As kDepthRans, kThermalRans and kScaledThermalRans, in strips (common/codec).
  kDepthStrips = 7,
  kThermalStrips = 8,
  kScaledThermalStrips = 9,
};
inline constexpr Encoding kLastEncoding = Encoding::kScaledThermalStrips;

constexpr bool IsScaled(Encoding encoding) {
  return encoding == Encoding::kScaledThermalRans || encoding == Encoding::kScaledRaw16 ||
         encoding == Encoding::kScaledThermalStrips;
}

constexpr bool IsRaw(Encoding encoding) {
  return encoding == Encoding::kRaw16 || encoding == Encoding::kCounts16 ||
         encoding == Encoding::kScaledRaw16;
}

/// Holds an image of 16-bit pixels in its encoded form; Decode (codec.h) checks it before anything
/// is allocated.
struct EncodedImage {
  Encoding encoding = Encoding::kRaw16;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> payload;
};

/// A frame on its way between processes or into a file: everything but the pixels is as in the
/// frame.
struct EncodedDepthFrame {
  FrameHeader header;
  EncodedImage image;
  double depth_scale = 1000.0;
};

/// The same for thermal frames. The raw counts mean nothing without `scale`.
struct EncodedThermalFrame {
  FrameHeader header;
  EncodedImage image;
  RadiometricScale scale{};  ///< kCentikelvin unless the image's encoding is scaled.
  NucState nuc_state = NucState::kUnknown;
  NucSource nuc_source = NucSource::kUnknown;
  std::optional<double> seconds_since_nuc;
  ThermalHousekeeping housekeeping;
  bool valid = false;
};

using DepthFramePtr = std::shared_ptr<const DepthFrame>;
using ThermalFramePtr = std::shared_ptr<const ThermalFrame>;

}  // namespace isotherm
