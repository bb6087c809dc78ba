#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "edge/usb/uvc_payload.h"

namespace isotherm {

/// Holds what a count means: kelvin = kelvin_per_count x count + offset_kelvin, apparent
/// temperature. Emissivity, reflection and transmission are applied by the ground, never by a
/// driver.
struct PixelEncoding {
  bool radiometric = false;  ///< False: counts without a known relation to temperature.
  double kelvin_per_count = 0.0;
  double offset_kelvin = 0.0;

  friend bool operator==(const PixelEncoding&, const PixelEncoding&) = default;
};

/// One frame as the camera sent it.
struct RawThermalFrame {
  Image<std::uint16_t> counts;  ///< height x width, row-major; rows of metadata are taken off.
  PixelEncoding encoding;
  HostStamp first_packet;                   ///< When the frame's first byte reached us.
  std::optional<DeviceTicks> device_ticks;  ///< Camera clock, unwrapped; nullopt = it has none.
  /// The camera's count of images, unwrapped. Repeated = the same image again.
  std::optional<std::uint64_t> device_counter;
  std::optional<CameraNuc> nuc;  ///< Nullopt = the camera says nothing.
  bool shutter_closed = false;   ///< By the camera's word.
  ThermalHousekeeping housekeeping;
  bool incomplete = false;           ///< Parts are missing or damaged; counts must not be used.
  std::uint64_t dropped_before = 0;  ///< Frames that came before it and were not read in time.
};

/// Names the measuring ranges of cameras that have two: kHigh resolves finely, kLow reaches higher
/// temperatures.
enum class ThermalGain { kKeep, kHigh, kLow };

/// "high" or "low".
inline std::string_view NameOf(ThermalGain gain) {
  return gain == ThermalGain::kHigh ? "high" : "low";
}

/// Holds the apparent temperatures between which a camera measures, °C.
struct MeasuringRange {
  double min_celsius = 0.0;
  double max_celsius = 0.0;
};

/// Describes a connected camera.
struct ThermalCameraInfo {
  std::string driver;    ///< E.g. "lepton-uvc".
  std::string product;   ///< As the camera calls itself.
  std::string serial;    ///< Empty: it has none.
  std::string bus_port;  ///< E.g. "1-2.3".
  int width = 0;
  int height = 0;
  double rate_hz = 0.0;  ///< Nominal.
  std::string settings;  ///< Its settings, made or found, for people: "gain low".
  /// As set, after SetGain; nullopt = not known.
  std::optional<MeasuringRange> range;
  /// It measures no temperatures: no frame is radiometric.
  bool counts_only = false;
  /// The device counter grows by this much from image to image; 0 = there is no counter, and
  /// images are told apart by their pixels.
  int counter_step = 0;
  int native_repeats = 1;     ///< How often each image is sent: 1 = once.
  Nanoseconds start_time{0};  ///< From Open until the first image must be there.
};

/// One thermal camera: how its bytes come and what they mean. Thread-bound.
///
///   closed --Open--> streaming --Close--> closed
class ThermalCamera {
 public:
  virtual ~ThermalCamera() = default;

  /// Finds out what the camera is and starts its stream.
  virtual Status Open() = 0;
  /// Known after Open.
  virtual const ThermalCameraInfo& info() const = 0;
  /// The next frame, or nullopt if none came within `timeout`. A failure means that the camera must
  /// be closed and opened again.
  virtual Result<std::optional<RawThermalFrame>> Read(Nanoseconds timeout) = 0;
  /// Stops the stream. Idempotent.
  virtual void Close() = 0;

  /// Corrects now. That it is done is seen in the frames, not here.
  virtual Status TriggerNuc() { return Refuse("cannot be told to correct itself"); }
  virtual Status SetAutomaticNuc(bool /*on*/) {
    return Refuse("decides by itself when to correct itself");
  }
  /// Sets the measuring range, reads it back where the camera can be asked, and puts it
  /// into info().settings. kFailedPrecondition if the camera keeps another one.
  virtual Status SetGain(ThermalGain gain) {
    return gain == ThermalGain::kKeep ? OkStatus() : Refuse("has one range only");
  }

 protected:
  Status Refuse(const std::string& what) const {
    return FailedPrecondition("thermal camera (" + info().driver + ") " + what);
  }
};

}  // namespace isotherm
