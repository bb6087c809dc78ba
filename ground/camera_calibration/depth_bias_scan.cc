#include "ground/camera_calibration/depth_bias_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "common/codec/codec.h"
#include "common/recording/recording.h"

namespace isotherm {
namespace {

constexpr double kReading = 0.8;  // Of the progress.

/// In metres, 0 = no return or outside of what the depth camera can see.
Image<float> ToMetres(const Image<std::uint16_t>& raw, double units_per_m,
                      const DepthSensorModel& sensor) {
  Image<float> depth_m(raw.width(), raw.height());
  std::transform(
      raw.pixels().begin(), raw.pixels().end(), depth_m.pixels().begin(), [&](std::uint16_t units) {
        const double depth = units / units_per_m;
        const bool is_measured = units != kNoDepth && units != kNoDepthSaturated &&
                                 depth >= sensor.min_depth_m && depth <= sensor.max_depth_m;
        return is_measured ? static_cast<float>(depth) : 0.0F;
      });
  return depth_m;
}

Status CheckSerial(const std::string& recorded, const std::string& in_file) {
  if (recorded.empty() || in_file.empty() || recorded == in_file) return OkStatus();
  return FailedPrecondition(fmt::format(
      "the wall was recorded by the depth camera with serial number {}, the calibration "
      "is of one with {}: name that of this camera, --rig",
      recorded, in_file));
}

Status CheckCamera(const Rig& rig) {
  if (!rig.depth) {
    return FailedPrecondition(
        "the calibration has no depth camera: see `isotherm calibrate depth --help`, or name "
        "another one, --rig");
  }
  return OkStatus();
}

}  // namespace

Result<DepthBiasReport> FindDepthBias(const std::filesystem::path& recording,
                                      std::optional<Rig>& rig,
                                      const std::function<void(double)>& progress) {
  const auto fail = [&](const Status& status) {
    return Err(status.WithContext(recording.string()));
  };
  const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(recording);
  if (!reader) return Err(reader.error());
  const bool is_given = rig.has_value();
  Result<Rig> recorded = (*reader)->ReadRig();
  if (!is_given) {
    if (!recorded) return fail(recorded.error());
    rig = std::move(*recorded);
  } else if (recorded) {
    if (Status same = CheckSerial(recorded->depth_serial, rig->depth_serial); !same.ok())
      return fail(same);
  }
  if (Status status = CheckCamera(*rig); !status.ok()) return fail(status);
  const CameraModel& camera = *rig->depth;
  DepthBiasFit fit(camera, rig->depth_sensor.bias);
  std::uint64_t total = 0, read = 0;
  for (const auto& [topic, count] : (*reader)->info().messages_by_topic) total += count;
  while (true) {
    const Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (item && !*item) break;
    if (++read, total > 0 && progress)
      progress(kReading * std::min(1.0, static_cast<double>(read) / static_cast<double>(total)));
    if (!item) continue;  // What of a damaged recording cannot be read is not needed either.
    const auto* depth = std::get_if<RecordedDepth>(&**item);
    if (depth == nullptr) continue;
    const auto raw = Decode(depth->frame.image);
    if (!raw) continue;
    if (raw->width() != camera.width || raw->height() != camera.height) {
      return fail(FailedPrecondition(fmt::format(
          "depth images have {} x {} pixels, the calibration is for {} x {}: name that of this "
          "camera, --rig",
          raw->width(), raw->height(), camera.width, camera.height)));
    }
    const double units_per_m = is_given ? rig->depth_scale : depth->frame.depth_scale;
    fit.Add(ToSeconds(depth->frame.header.capture_time.time_since_epoch()),
            ToMetres(*raw, units_per_m, rig->depth_sensor));
  }
  Result<DepthBiasReport> report = fit.Solve([&](double fraction) {
    if (progress) progress(kReading + (1.0 - kReading) * fraction);
  });
  if (!report) return fail(report.error());
  return report;
}

}  // namespace isotherm
