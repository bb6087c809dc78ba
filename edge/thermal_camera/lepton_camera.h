#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/time/clock.h"
#include "edge/thermal_camera/counter.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

class UvcCamera;

/// FLIR Lepton 2.x and 3.x on a PureThermal board (USB video class, 16-bit images with
/// telemetry). Thread-bound.
class LeptonCamera final : public ThermalCamera {
 public:
  static constexpr const char* kDriver = "lepton-uvc";

  /// `clock` must outlive it.
  LeptonCamera(std::string bus_port, const Clock& clock);
  ~LeptonCamera() override;

  Status Open() override;
  const ThermalCameraInfo& info() const override { return info_; }
  Result<std::optional<RawThermalFrame>> Read(Nanoseconds timeout) override;
  void Close() override;
  Status TriggerNuc() override;
  Status SetAutomaticNuc(bool on) override;
  Status SetGain(ThermalGain gain) override;

 private:
  Status StartBestMode();
  Status CheckOpen() const;
  /// 0 high, 1 low, 2 automatic.
  Result<std::uint32_t> ReadGain();

  const Clock& clock_;
  ThermalCameraInfo info_;
  std::unique_ptr<UvcCamera> camera_;
  Unwrapper uptime_{32};
  Unwrapper counter_{32};
};

}  // namespace isotherm
