#include "edge/daemon/rig_announcer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/log.h"

namespace isotherm {

RigAnnouncer::RigAnnouncer(const EdgeOptions& options, EdgeSession start,
                           const CameraHealth& health, Publisher& publisher,
                           std::function<void(RigUpdate)> record)
    : options_(options),
      health_(health),
      publisher_(publisher),
      record_(std::move(record)),
      announced_(std::move(start)) {}

bool RigAnnouncer::IsAnnounced(Sensor sensor) const {
  return std::ranges::any_of(announced_.cameras, [sensor](const CameraDescription& camera) {
    return camera.sensor == sensor;
  });
}

void RigAnnouncer::Tick() {
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    if (IsAnnounced(sensor)) continue;
    std::optional<CameraDescription> camera = health_.opened(sensor);
    if (!camera) continue;
    if (announced_.rig && sensor == Sensor::kThermal && !camera->counts_only)
      TakeScale(camera->thermal_scale, *announced_.rig);
    announced_.cameras.push_back(std::move(*camera));
    record_({announced_.rig, CameraMetadata(announced_.cameras)});
    is_due_ = true;
  }
  if (!is_due_) return;
  const Status status = publisher_.Announce(DescribeRig(options_, announced_));
  if (!status.ok() && status.message() != problem_) {
    LOG(Edge, Warning) << "a camera is not announced yet: " << status.message();
  }
  problem_ = status.message();
  is_due_ = !status.ok();
}

}  // namespace isotherm
