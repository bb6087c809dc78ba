#include "edge/daemon/resume_scan.h"

#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/base/log.h"
#include "common/frame/sensor_name.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "edge/options/edge_options.pb.h"
#include "edge/timestamper/time_base.h"

namespace isotherm {
namespace {

constexpr std::array kSensors = {Sensor::kDepth, Sensor::kThermal};

std::uint64_t& FirstNumber(EdgeSession& session, Sensor sensor) {
  return session.first_numbers[static_cast<std::size_t>(sensor)];
}
std::uint64_t FirstNumber(const EdgeSession& session, Sensor sensor) {
  return session.first_numbers[static_cast<std::size_t>(sensor)];
}

/// Compares what a recording gives back, but for rounding and for the thermal scale, which is that
/// of a camera that may not be there yet. Without a file the rig is what the cameras say of
/// themselves: one that is missing on one side says nothing.
bool IsSameRig(std::optional<Rig> recorded, std::optional<Rig> rig, bool has_file) {
  if (!recorded || !rig) return !has_file || recorded.has_value() == rig.has_value();
  recorded->thermal_scale = rig->thermal_scale;
  if (!has_file) {
    if (!recorded->depth || !rig->depth) recorded->depth = rig->depth = std::nullopt;
    if (!recorded->thermal || !rig->thermal) recorded->thermal = rig->thermal = std::nullopt;
  }
  return google::protobuf::util::MessageDifferencer::ApproximatelyEquals(ToProto(*recorded),
                                                                         ToProto(*rig));
}

/// Returns which of the cameras that are there has come in place of another one; empty: none. A
/// camera that neither start has seen is not known.
std::string OtherCamera(const RecordingDescription::Metadata& recorded,
                        const std::vector<CameraDescription>& cameras) {
  const auto known = recorded.find("cameras");
  if (known == recorded.end()) return {};
  const std::map<std::string, std::string> present = CameraMetadata(cameras);
  for (const CameraDescription& camera : cameras) {
    const std::string name(NameOf(camera.sensor));
    for (const std::string& key : {name, name + "_serial", name + "_mode"}) {
      const auto before = known->second.find(key);
      if (before != known->second.end() && before->second != present.at(key))
        return before->second + " was, " + present.at(key) + " is the " + name + " camera";
    }
  }
  return {};
}

/// Says why the scan cannot be gone on with; empty: it can.
std::string Obstacle(const InterruptedScan& scan, const EdgeSession& session, bool has_file) {
  if (!IsSameRig(scan.rig, session.rig, has_file)) return "the calibration is another one";
  return OtherCamera(scan.metadata, session.cameras);
}

}  // namespace

std::optional<InterruptedScan> FindScanToResume(const EdgeOptions& options,
                                                const EdgeSession& session) {
  // Frames of a replay that keeps its own times would come a second time.
  if (TimeBaseOf(options.source()) != TimeBase::kWallClock) return std::nullopt;
  std::optional<InterruptedScan> scan =
      FindInterruptedScan(options.spool().record(), options.link().edge_id(), session.time,
                          FromSeconds(options.spool().resume_s()));
  if (!scan) return std::nullopt;
  const bool has_file = !options.source().rig_file().empty();
  if (const std::string obstacle = Obstacle(*scan, session, has_file); !obstacle.empty()) {
    LOG(Edge, Warning) << "the scan in " << scan->path.string()
                       << " was interrupted, and another one is begun: " << obstacle;
    return std::nullopt;
  }
  return scan;
}

void Resume(const InterruptedScan& before, EdgeSession& session) {
  session.resumed_session = before.last.session;
  for (const Sensor sensor : kSensors)
    FirstNumber(session, sensor) = before.NextNumber(sensor, session.time);
  LOG(Edge, Warning) << "the scan in " << before.path.string()
                     << " was interrupted, and goes on: session=" << before.last.session
                     << " recorded depth=" << before.Of(Sensor::kDepth).frames
                     << " thermal=" << before.Of(Sensor::kThermal).frames
                     << ", nothing recorded for s=" << ToSeconds(session.time - before.newest);
}

SessionBefore PublishedBy(const InterruptedScan& before, const EdgeSession& session) {
  const auto published = [&](Sensor sensor) {
    const RecordedStream& stream = before.Of(sensor);
    return PublishedBefore{stream.frames, stream.next, FirstNumber(session, sensor)};
  };
  return {published(Sensor::kDepth), published(Sensor::kThermal)};
}

void CountBefore(const InterruptedScan& before, const EdgeSession& session,
                 FrameCounters& counters) {
  for (const Sensor sensor : kSensors) {
    const std::uint64_t recorded = before.Of(sensor).frames;
    counters.Count(sensor, FrameFate::kCaptured, recorded);
    counters.Count(sensor, FrameFate::kPublished, recorded);
    // Of a camera that has never been there nothing is lost.
    if (recorded > 0)
      counters.Count(
          sensor, FrameFate::kLostByRestart,
          FirstNumber(session, sensor) - std::min(FirstNumber(session, sensor), recorded));
  }
}

}  // namespace isotherm
