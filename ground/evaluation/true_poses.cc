#include "ground/evaluation/true_poses.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/dataset/text_lines.h"
#include "common/dataset/trajectory.h"
#include "common/recording/recording.h"

namespace isotherm {
namespace {

/// A frame may be stamped a little before the first or behind the last true pose (half an exposure,
/// a delay).
constexpr Nanoseconds kBeyondEnds = std::chrono::milliseconds(50);

// Calls `visit(item)` for every item that can be read until it returns false.
template <typename Visit>
Status ForEachItem(const std::filesystem::path& recording, const Visit& visit) {
  const auto reader = RecordingReader::Open(recording);
  if (!reader) return reader.error();
  for (;;) {
    const Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (!item) continue;
    if (!*item || !visit(**item)) return OkStatus();
  }
}

bool Earlier(const StampedPose& a, const StampedPose& b) { return a.time < b.time; }

}  // namespace

Result<std::vector<StampedPose>> ReadTruePoses(const std::filesystem::path& path) {
  if (path.extension() != ".mcap") return ReadTrajectory(path);
  std::vector<StampedPose> poses;
  const Status status = ForEachItem(path, [&](const RecordedItem& item) {
    const auto* recorded = std::get_if<RecordedPose>(&item);
    if (recorded != nullptr && recorded->stream == "groundtruth") poses.push_back(recorded->pose);
    return true;
  });
  if (!status.ok()) return Err(status);
  if (poses.empty())
    return Err(NotFound(fmt::format("{}: the recording has no ground truth", path.string())));
  std::stable_sort(poses.begin(), poses.end(), Earlier);
  return poses;
}

Result<RigidTransform> PoseAt(const std::vector<StampedPose>& poses, CaptureTime time) {
  if (poses.empty() || time < poses.front().time - kBeyondEnds ||
      time > poses.back().time + kBeyondEnds) {
    return Err(FailedPrecondition(fmt::format("there is no pose near {}", FormatStamp(time))));
  }
  const auto after = std::lower_bound(poses.begin(), poses.end(), StampedPose{time, {}}, Earlier);
  if (after == poses.end()) return poses.back().T_world_depth;
  if (after == poses.begin() || after->time == time) return after->T_world_depth;
  const StampedPose& before = *(after - 1);
  const double alpha = ToSeconds(time - before.time) / ToSeconds(after->time - before.time);
  return Interpolate(before.T_world_depth, after->T_world_depth, alpha);
}

Result<CaptureTime> FirstDepthTime(const std::filesystem::path& recording) {
  std::optional<CaptureTime> first;
  const Status status = ForEachItem(recording, [&](const RecordedItem& item) {
    if (const auto* depth = std::get_if<RecordedDepth>(&item))
      first = depth->frame.header.capture_time;
    return !first;
  });
  if (!status.ok()) return Err(status);
  if (!first)
    return Err(FailedPrecondition(fmt::format("{}: has no depth frames", recording.string())));
  return *first;
}

Result<std::vector<CaptureTime>> RepeatedDepthFrames(const std::filesystem::path& recording) {
  std::vector<CaptureTime> repeats;
  EncodedImage last;
  const Status status = ForEachItem(recording, [&](const RecordedItem& item) {
    const auto* depth = std::get_if<RecordedDepth>(&item);
    if (depth == nullptr) return true;
    const EncodedImage& image = depth->frame.image;
    // Our codes are deterministic: equal images have equal codes.
    if (image.encoding == last.encoding && image.payload == last.payload) {
      repeats.push_back(depth->frame.header.capture_time);
    }
    last = image;
    return true;
  });
  if (!status.ok()) return Err(status);
  std::sort(repeats.begin(), repeats.end());
  return repeats;
}

}  // namespace isotherm
