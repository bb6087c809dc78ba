#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/time/clock.h"
#include "edge/thermal_camera/infiray_protocol.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

class UvcCamera;

/// InfiRay P2 Pro, Topdon TC001, Tiny1-C (USB video class, 256x384 words). Frames say nothing about
/// the shutter: it is asked for some times per second. Thread-bound.
class P2ProCamera final : public ThermalCamera {
 public:
  static constexpr const char* kDriver = "p2pro-uvc";

  /// `clock` must outlive it.
  P2ProCamera(std::string bus_port, const Clock& clock);
  ~P2ProCamera() override;

  Status Open() override;
  const ThermalCameraInfo& info() const override { return info_; }
  Result<std::optional<RawThermalFrame>> Read(Nanoseconds timeout) override;
  void Close() override;
  Status TriggerNuc() override;
  Status SetAutomaticNuc(bool on) override;
  Status SetGain(ThermalGain gain) override;

 private:
  /// Sends eight bytes and waits until the camera has done it.
  Status Command(std::uint16_t word, std::uint32_t parameter, std::uint16_t length = 0);
  Status SetParameter(std::uint16_t parameter, std::uint32_t value);
  Result<std::uint16_t> GetParameter(std::uint16_t parameter);
  Status ApplyGain();
  Status Send(std::uint16_t index, const std::vector<std::uint8_t>& bytes);
  Result<std::vector<std::uint8_t>> Receive(std::uint16_t index, std::size_t size);
  Status WaitUntilReady();
  /// Sets what cannot be set before the camera answers; called between frames until it is done.
  void ConfigureWhenDue(SteadyTime now);
  void AskShutterWhenDue(SteadyTime now);

  const Clock& clock_;
  ThermalCameraInfo info_;
  std::unique_ptr<UvcCamera> camera_;
  PolledShutter shutter_;
  SteadyTime opened_at_{};
  SteadyTime next_command_at_{};
  bool configured_ = false;
  bool started_cold_ = false;
  ThermalGain gain_ = ThermalGain::kKeep;
  std::optional<bool> automatic_;
  int unanswered_ = 0;
};

}  // namespace isotherm
