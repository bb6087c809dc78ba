#include "edge/thermal_camera/frame_novelty.h"

namespace isotherm {
namespace {

bool IsCorrecting(const RawThermalFrame& frame) {
  return frame.nuc && frame.nuc->state == NucState::kInProgress;
}

}  // namespace

Novelty FrameNovelty::Process(const RawThermalFrame& frame) {
  const bool same_counter = missed_ && frame.device_counter == counter_;
  const bool same_image = images_.Add(frame.counts) > 0;
  const bool repeated = same_image || (frame.device_counter && same_counter);
  Novelty novelty;
  if (repeated) {
    ++repeats_;
    novelty.kind =
        IsFrozen(repeats_, native_repeats_) ? Novelty::Kind::kFrozen : Novelty::Kind::kRepeat;
    novelty.frozen_for = frame.first_packet.steady - first_seen_;
  } else {
    novelty.lost = LostBefore(frame);
    repeats_ = 0;
    first_seen_ = frame.first_packet.steady;
  }
  counter_ = frame.device_counter;
  was_correcting_ = IsCorrecting(frame);
  return novelty;
}

std::uint64_t FrameNovelty::LostBefore(const RawThermalFrame& frame) {
  if (!missed_ || !frame.device_counter) return 0;
  // While it corrects itself a camera's counter may stand still, and jumps afterwards.
  if (!was_correcting_) return missed_->Process(*frame.device_counter);
  missed_->Restart(*frame.device_counter);
  return 0;
}

}  // namespace isotherm
