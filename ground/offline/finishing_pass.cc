#include "ground/offline/finishing_pass.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "common/recording/recording.h"
#include "ground/assembler/assembler.h"
#include "ground/offline/recorded_frames.h"

namespace isotherm {
namespace {

class FinishingDriver {
 public:
  FinishingDriver(const FirstPass& first, ThermalPass& pass)
      : first_(first), pass_(pass), assembler_(true) {}

  void Take(const RecordedItem& item) {
    if (const auto* depth = std::get_if<RecordedDepth>(&item)) {
      if (auto frame = Unpack(*depth, first_.depth_scale)) assembler_.Add(std::move(*frame));
    } else if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
      if (auto frame = Unpack(*thermal, first_.thermal_delay)) assembler_.Add(std::move(*frame));
    }
    while (const auto frame = assembler_.Pop()) Process(*frame);
  }

  void Finish() {
    while (const auto frame = assembler_.Flush()) Process(*frame);
    pass_.Finish();
  }

 private:
  void Process(const Assembler::Frame& frame) {
    if (const auto* depth = std::get_if<DepthFramePtr>(&frame)) {
      pass_.ProcessDepth(**depth);
      return;
    }
    const ThermalFramePtr& thermal = std::get<ThermalFramePtr>(frame);
    if (!std::ranges::binary_search(first_.held_out, thermal->header.capture_time))
      pass_.ProcessThermal(thermal);
  }

  const FirstPass& first_;
  ThermalPass& pass_;
  Assembler assembler_;
};

}  // namespace

Status FuseOnFinishedSurface(const FirstPass& first, ThermalPass& pass,
                             const std::function<void(double)>& progress) {
  const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(first.recording);
  if (!reader) return reader.error();
  FinishingDriver driver(first, pass);
  const auto told_before = [](const Status& /*error*/) {};
  ReadItems(
      **reader, [&driver](const RecordedItem& item) { driver.Take(item); }, told_before, progress,
      first.stop);
  driver.Finish();
  return OkStatus();
}

}  // namespace isotherm
