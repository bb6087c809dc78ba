#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/geometry/external_odometry.h"
#include "common/rig/rig.h"

namespace isotherm {

/// No frame within the time a Read may take; try again.
struct NothingYet {};
/// The source has delivered all it has.
struct EndOfStream {};

/// Correct the thermal camera now.
struct TriggerNuc {};
/// Let the thermal camera correct itself when it sees fit, or only when told to.
struct SetAutomaticNuc {
  bool on = true;
};
/// Open the thermal camera again: its frames are frozen.
struct RestartCamera {};
using CameraControl = std::variant<TriggerNuc, SetAutomaticNuc, RestartCamera>;

/// Holds what the camera says to an order: ok, or why not. kFailedPrecondition: it takes no such
/// order, now or later; anything else: it did not this time.
struct ControlAnswer {
  CameraControl control;
  Status status;
};

using SourceItem = std::variant<RawFrame, ExternalOdometry, NothingYet, EndOfStream>;

/// A camera as it was found when it was opened: what was read back, not what was asked for.
struct CameraDescription {
  Sensor sensor = Sensor::kDepth;
  std::string driver;  ///< "openni2", "lepton-uvc", ...
  std::string model;
  std::string serial;    ///< Empty: the camera does not say.
  int width = 0;         ///< Pixels.
  int height = 0;        ///< Pixels.
  double rate_hz = 0.0;  ///< 0 = not known.
  std::string settings;  ///< Other settings, for people: "unit 1 mm, mirroring off".
  /// Thermal only: its pixels are counts that nothing relates to temperatures.
  bool counts_only = false;
  /// Thermal only: what its pixels mean otherwise.
  RadiometricScale thermal_scale{};
};

/// Delivers frames of one or more sensors as the device and the host gave them, and poses of the
/// rig that external odometry measured, on the edge's wall clock. Thread-bound: one thread opens,
/// reads and closes.
class FrameSource {
 public:
  /// A Read that waits for its device waits this long: half of what is allowed.
  static constexpr Nanoseconds kReadWait = std::chrono::milliseconds(50);

  virtual ~FrameSource() = default;

  virtual std::string_view name() const = 0;
  virtual Status Open() = 0;
  /// Waits a bounded time (at most 0.1 s; sources use kReadWait) for the next frame; returns at
  /// once when stop is requested. A failure means that the source must be closed and opened again.
  virtual Result<SourceItem> Read(std::stop_token stop) = 0;
  virtual void Close() = 0;
  /// After Close: a frame that was captured but not read, until there is none. Sources with threads
  /// of their own may have some.
  virtual std::optional<RawFrame> TakeUnread() { return std::nullopt; }
  /// By Sensor: frames that were captured since the last call and left out before Read could give
  /// them, because they were not read in time; they leave holes in the numbers. Also after Close.
  virtual std::array<std::uint64_t, 2> TakeLeftOut() { return {}; }
  /// Tells the camera what to do; takes at most some milliseconds. Returns the camera's answer, as
  /// in ControlAnswer, or nullopt if it comes later with TakeControlAnswers.
  virtual std::optional<Status> Control(const CameraControl& /*control*/) {
    return FailedPrecondition("the source has no shutter to command");
  }
  /// Answers that have come since the last call: one for each order that Control left open, also
  /// when the camera fails or is closed meanwhile.
  virtual std::vector<ControlAnswer> TakeControlAnswers() { return {}; }
  /// Calibration that comes with the frames, known after Open; nullopt if the source has none (a
  /// bare camera).
  virtual std::optional<Rig> rig() const { return std::nullopt; }
  /// The cameras that were opened, known after Open; none if there is no camera behind the source.
  virtual std::vector<CameraDescription> cameras() const { return {}; }
};

}  // namespace isotherm
