#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/time/clock.h"
#include "edge/thermal_camera/counter.h"
#include "edge/thermal_camera/seek_protocol.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

class UsbDevice;

/// Seek Compact, CompactXR and CompactPro (vendor protocol, bulk transfers). Frames are asked for
/// one by one, so the rate is what camera and computer make of it. They are counts: nobody has
/// published what temperatures they mean. The camera closes its shutter when it sees fit and sends
/// what it saw then; that frame is passed on as a correction. Thread-bound.
class SeekCamera final : public ThermalCamera {
 public:
  static constexpr const char* kDriver = "seek-bulk";

  /// `clock` must outlive it.
  SeekCamera(std::string bus_port, const SeekModel& model, const Clock& clock);
  ~SeekCamera() override;

  Status Open() override;
  const ThermalCameraInfo& info() const override { return info_; }
  Result<std::optional<RawThermalFrame>> Read(Nanoseconds timeout) override;
  void Close() override;
  Status TriggerNuc() override;

 private:
  Status Begin();
  /// Wakes the camera, after putting it to sleep if somebody left it running.
  Status Wake();
  void Sleep();
  /// Sends a request, or reads its answer.
  Result<std::vector<std::uint8_t>> Do(const SeekRequest& request);
  Status AskForFrame();
  /// Throws away what the camera still sends of a frame that was given up.
  Status Drain();
  /// A whole frame has come.
  Result<std::optional<RawThermalFrame>> Finish();
  Result<std::optional<RawThermalFrame>> GiveUp();

  const Clock& clock_;
  const SeekModel model_;
  ThermalCameraInfo info_;
  std::unique_ptr<UsbDevice> device_;
  SeekAssembler assembler_;
  SeekImageMaker images_;
  Unwrapper counter_{16};
  std::optional<std::uint16_t> next_counter_;
  std::optional<SteadyTime> asked_at_;  ///< Nullopt: no frame is under way.
  bool out_of_step_ = false;            ///< The camera may still send parts of an old frame.
  bool started_ = false;                ///< Its first frame has come.
  int starts_ = 0;                      ///< Since Open.
  std::uint64_t left_out_ = 0;          ///< Frames that are no images; the camera counts them.
};

}  // namespace isotherm
