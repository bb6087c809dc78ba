#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "common/time/clock.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm::testing {

/// The scripted camera's.
inline constexpr Nanoseconds kPeriod = std::chrono::milliseconds(100);

/// Holds what a test makes a camera send; shared with the cameras that the source makes.
struct Script {
  ThermalCameraInfo info;
  std::deque<std::function<Result<std::optional<RawThermalFrame>>()>> reads;
  int opened = 0;
  int closed = 0;
  int corrections = 0;
  ThermalGain gain = ThermalGain::kKeep;
};

/// A camera that does what the script says, one read per 100 ms, and is silent at its end.
class ScriptedCamera final : public ThermalCamera {
 public:
  ScriptedCamera(Script& script, FakeClock& clock) : script_(script), clock_(clock) {}
  Status Open() override {
    ++script_.opened;
    return OkStatus();
  }
  const ThermalCameraInfo& info() const override { return script_.info; }
  Result<std::optional<RawThermalFrame>> Read(Nanoseconds) override {
    clock_.Advance(kPeriod);
    if (script_.reads.empty()) return std::optional<RawThermalFrame>();
    auto read = script_.reads.front();
    script_.reads.pop_front();
    Result<std::optional<RawThermalFrame>> frame = read();
    if (frame && *frame) (*frame)->first_packet = {clock_.Now(), clock_.SteadyNow()};
    return frame;
  }
  void Close() override { ++script_.closed; }
  Status TriggerNuc() override {
    ++script_.corrections;
    return OkStatus();
  }
  Status SetGain(ThermalGain gain) override {
    script_.gain = gain;
    return OkStatus();
  }

 private:
  Script& script_;
  FakeClock& clock_;
};

}  // namespace isotherm::testing
