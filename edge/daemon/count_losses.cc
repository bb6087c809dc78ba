#include "edge/daemon/count_losses.h"

namespace isotherm {

void CountLosses(SupervisedSource& camera, FrameAccount& account) {
  camera.OnLoss([&account](Sensor sensor, SupervisedSource::Loss loss, std::uint64_t frames) {
    const bool left_out = loss == SupervisedSource::Loss::kLeftOut;
    if (left_out) account.Count(sensor, FrameFate::kCaptured, frames);
    account.Count(sensor, left_out ? FrameFate::kLeftOut : FrameFate::kLostInCamera, frames);
  });
}

}  // namespace isotherm
