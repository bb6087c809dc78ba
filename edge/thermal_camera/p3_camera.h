#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/time/clock.h"
#include "edge/thermal_camera/counter.h"
#include "edge/thermal_camera/p3_protocol.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

class UsbDevice;

/// Thermal Master P3 and P1 (vendor protocol, bulk transfers). The camera takes three seconds to
/// start; they pass while Read is called. Thread-bound.
class P3Camera final : public ThermalCamera {
 public:
  static constexpr const char* kDriver = "p3-bulk";

  /// `clock` must outlive it.
  P3Camera(std::string bus_port, const P3Layout& layout, const Clock& clock);
  ~P3Camera() override;

  Status Open() override;
  const ThermalCameraInfo& info() const override { return info_; }
  Result<std::optional<RawThermalFrame>> Read(Nanoseconds timeout) override;
  void Close() override;
  Status TriggerNuc() override;
  Status SetGain(ThermalGain gain) override;

 private:
  /// A command with what belongs to it: acknowledgements, and an answer if it has one.
  Result<std::vector<std::uint8_t>> Command(std::uint16_t type, std::uint16_t parameter,
                                            std::uint16_t reg, std::uint16_t answer_bytes);
  Status Acknowledge();
  Status StartStep();
  Status BeginStream();
  RawThermalFrame Convert(const UvcFrame& frame, P3Frame parsed);

  const Clock& clock_;
  const P3Layout layout_;
  ThermalCameraInfo info_;
  std::unique_ptr<UsbDevice> device_;
  std::optional<P3Assembler> assembler_;
  Unwrapper stamp_{32};
  Unwrapper counter_{16};
  int step_ = 0;  ///< How far the start has come; see StartStep.
  SteadyTime next_step_at_{};
};

}  // namespace isotherm
