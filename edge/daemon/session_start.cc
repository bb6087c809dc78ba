#include "edge/daemon/session_start.h"

#include <fmt/format.h>

#include <map>
#include <random>
#include <string>

#include "common/base/log.h"
#include "common/codec/codec.h"
#include "common/frame/sensor_name.h"
#include "common/options/text_proto.h"
#include "common/recording/clock_record.h"
#include "edge/daemon/edge_report.h"
#include "edge/options/edge_options.pb.h"
#include "edge/spool/interrupted_scan.h"
#include "edge/timestamper/time_base.h"

namespace isotherm {
namespace {

/// Returns the scale that thermal frames have: the camera's, or that of the frames that are played.
RadiometricScale ScaleOfFrames(const FrameSource& source, const Rig& rig) {
  for (const CameraDescription& camera : source.cameras()) {
    if (camera.sensor == Sensor::kThermal && !camera.counts_only) return camera.thermal_scale;
  }
  if (!source.cameras().empty()) return rig.thermal_scale;  // Until it is there (RigAnnouncer).
  const std::optional<Rig> played = source.rig();
  return played ? played->thermal_scale : rig.thermal_scale;
}

/// "lepton-uvc, PureThermal".
std::string ModelText(const CameraDescription& camera) {
  return fmt::format("{}, {}", camera.driver, camera.model);
}

Encoding EncodingOf(const CameraDescription& camera) {
  if (camera.sensor == Sensor::kDepth) return Encoding::kDepthStrips;
  return camera.counts_only ? Encoding::kCounts16 : TemperatureEncoding(camera.thermal_scale);
}

}  // namespace

std::uint64_t NewSession() {
  std::random_device random;
  std::uint64_t session = 0;
  while (session == 0) session = std::uint64_t{random()} << 32U | random();
  return session;
}

std::optional<Rig> AsPublished(std::optional<Rig> rig, const FrameSource& source) {
  if (!rig) return rig;
  rig->thermal_delay_s = 0.0;
  TakeScale(ScaleOfFrames(source, *rig), *rig);
  return rig;
}

void TakeScale(const RadiometricScale& scale, Rig& rig) {
  if (rig.thermal_scale != scale && rig.thermal_scale != kCentikelvin) {
    LOG(Edge, Warning) << "the calibration's thermal_scale and thermal_offset, K: "
                       << rig.thermal_scale.kelvin_per_count << " and "
                       << rig.thermal_scale.offset_kelvin << "; the thermal frames have "
                       << scale.kelvin_per_count << " and " << scale.offset_kelvin
                       << ", which hold";
  }
  rig.thermal_scale = scale;
}

RigDescription DescribeRig(const EdgeOptions& options, const EdgeSession& start) {
  RigDescription description;
  description.session = start.session();
  description.waits_for_ground = options.source().rate() == 0.0;
  if (start.rig) description.rig = *start.rig;
  const auto mode = [](const std::optional<CameraModel>& camera, Encoding encoding) {
    StreamMode stream;
    if (camera) stream = {camera->width, camera->height, 0.0, encoding, "", ""};
    return stream;
  };
  description.depth = mode(description.rig.depth, Encoding::kDepthStrips);
  description.thermal =
      mode(description.rig.thermal, TemperatureEncoding(description.rig.thermal_scale));
  for (const CameraDescription& camera : start.cameras) {
    StreamMode& stream = camera.sensor == Sensor::kDepth ? description.depth : description.thermal;
    stream = {camera.width,       camera.height, camera.rate_hz,
              EncodingOf(camera), camera.serial, ModelText(camera)};
  }
  return description;
}

std::map<std::string, std::string> CameraMetadata(const std::vector<CameraDescription>& cameras) {
  std::map<std::string, std::string> metadata;
  for (const CameraDescription& camera : cameras) {
    const std::string name(NameOf(camera.sensor));
    metadata[name] = ModelText(camera);
    metadata[name + "_serial"] = camera.serial;
    metadata[name + "_mode"] =
        fmt::format("{}x{}@{:g}", camera.width, camera.height, camera.rate_hz);
    metadata[name + "_settings"] = camera.settings;
  }
  return metadata;
}

RecordingDescription::Metadata RecordingMetadata(const EdgeOptions& options,
                                                 const EdgeSession& start) {
  const TimestamperOptions& timing = options.timestamper();
  RecordingDescription::Metadata metadata = {
      {"configuration", {{"edge", ToTextProto(options)}}},
      {std::string(kScanMetadata), ToMetadata(ScanPart{options.link().edge_id(), start.session(),
                                                       start.time, start.first_numbers})},
      {"software", {{"name", "isotherm-edge"}, {"version", ISOTHERM_VERSION}}},
      {std::string(kClockMetadata), ClockMetadata(start.clock, TimeBaseOf(options.source()))},
      {"timing",
       {{"depth_delay_s", fmt::format("{}", timing.expert().depth_delay_s())},
        {"thermal_delay_s",
         fmt::format("{}", timing.expert().thermal_delay_s() + start.rig_thermal_delay_s)}}}};
  if (!start.cameras.empty()) metadata["cameras"] = CameraMetadata(start.cameras);
  return metadata;
}

}  // namespace isotherm
