#include "edge/daemon/count_losses.h"

namespace isotherm {

void CountLosses(SupervisedSource& camera, FrameCounters& counters) {
  camera.OnLoss([&counters](Sensor sensor, SupervisedSource::Loss loss, std::uint64_t frames) {
    const bool left_out = loss == SupervisedSource::Loss::kLeftOut;
    if (left_out) counters.Count(sensor, FrameFate::kCaptured, frames);
    counters.Count(sensor, left_out ? FrameFate::kLeftOut : FrameFate::kLostInCamera, frames);
  });
}

}  // namespace isotherm
