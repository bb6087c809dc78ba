#include "ground/calibration/thermal_selection.h"

#include <utility>

#include "common/base/check.h"

namespace isotherm {

ThermalSelection::ThermalSelection(std::size_t max_frames) : max_frames_(max_frames) {
  CHECK(max_frames >= 2);
}

void ThermalSelection::Add(StampedThermal frame, double speed) {
  if (in_bucket_ < stride_ && !kept_.empty()) {
    ++in_bucket_;
    if (speed > kept_.back().speed) kept_.back() = {std::move(frame), speed};
    return;
  }
  if (kept_.size() == max_frames_) {
    Halve();
    // An odd last one stands for half of what it could.
    if (max_frames_ % 2 != 0) {
      in_bucket_ = stride_ / 2;
      Add(std::move(frame), speed);
      return;
    }
  }
  kept_.push_back({std::move(frame), speed});
  in_bucket_ = 1;
}

void ThermalSelection::Halve() {
  std::vector<Kept> halved;
  for (std::size_t i = 0; i < kept_.size(); i += 2) {
    const bool second = i + 1 < kept_.size() && kept_[i + 1].speed > kept_[i].speed;
    halved.push_back(std::move(kept_[second ? i + 1 : i]));
  }
  kept_ = std::move(halved);
  stride_ *= 2;
}

std::vector<StampedThermal> ThermalSelection::frames() const {
  std::vector<StampedThermal> frames;
  for (const Kept& kept : kept_) frames.push_back(kept.frame);
  return frames;
}

}  // namespace isotherm
