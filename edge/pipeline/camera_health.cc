#include "edge/pipeline/camera_health.h"

namespace isotherm {

void CameraHealth::SetWorks(Sensor sensor, bool works) {
  Entry& entry = At(sensor);
  if (!works) ++entry.failures;
  entry.state = works ? CameraState::kWorking : CameraState::kLost;
}

void CameraHealth::AddStamping(Sensor sensor, Nanoseconds latency) {
  Entry& entry = At(sensor);
  MutexLock lock(entry.mutex);
  entry.stamping_ms.Add(ToSeconds(latency) * 1e3);
}

void CameraHealth::NoteStamp(Sensor sensor, const Stamp& stamp) {
  Entry& entry = At(sensor);
  MutexLock lock(entry.mutex);
  entry.stamp_sigma_s = ToSeconds(stamp.sigma);
  if (!stamp.synchronised) ++entry.unsynchronised_frames;
}

void CameraHealth::SetOpened(const CameraDescription& camera) {
  Entry& entry = At(camera.sensor);
  MutexLock lock(entry.mutex);
  entry.opened = camera;
}

std::optional<CameraDescription> CameraHealth::opened(Sensor sensor) const {
  const Entry& entry = entries_[static_cast<std::size_t>(sensor)];
  MutexLock lock(entry.mutex);
  return entry.opened;
}

CameraReport CameraHealth::Get(Sensor sensor) const {
  const Entry& entry = entries_[static_cast<std::size_t>(sensor)];
  CameraReport report;
  report.state = entry.state;
  report.failures = entry.failures;
  // A lost camera shows nothing either; that it is lost says more.
  if (entry.blind && report.state != CameraState::kLost) report.state = CameraState::kBlind;
  MutexLock lock(entry.mutex);
  report.stamp_sigma_s = entry.stamp_sigma_s;
  report.unsynchronised_frames = entry.unsynchronised_frames;
  if (entry.stamping_ms.count() == 0) return report;
  report.stamping_p50_s = entry.stamping_ms.Percentile(50.0) / 1e3;
  report.stamping_p99_s = entry.stamping_ms.Percentile(99.0) / 1e3;
  return report;
}

}  // namespace isotherm
