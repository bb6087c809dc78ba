#include "ground/conversion/merged_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "common/base/log.h"
#include "common/codec/codec.h"

namespace isotherm {
namespace {

/// Tells an event from others of its time.
std::string NameOf(const RecordedItem& item) {
  struct Visitor {
    std::string operator()(const RecordedDepth& /*frame*/) const { return "depth"; }
    std::string operator()(const RecordedThermal& /*frame*/) const { return "thermal"; }
    std::string operator()(const NucEvent& /*event*/) const { return "nuc"; }
    std::string operator()(const RecordedPose& pose) const { return "pose " + pose.stream; }
    std::string operator()(const ExternalOdometry& /*pose*/) const { return "odometry"; }
    std::string operator()(const RecordedLog& log) const { return "log " + log.text; }
    std::string operator()(const ClockStep& /*step*/) const { return "clock"; }
  };
  return std::visit(Visitor(), item);
}

Status CheckImage(const RecordedItem& item) {
  const EncodedImage* image = nullptr;
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) image = &depth->frame.image;
  if (const auto* thermal = std::get_if<RecordedThermal>(&item)) image = &thermal->frame.image;
  if (image == nullptr) return OkStatus();
  const auto pixels = Decode(*image);
  return pixels ? OkStatus() : pixels.error();
}

Status CheckSameCamera(const char* sensor, const std::optional<CameraModel>& a,
                       const std::optional<CameraModel>& b, const std::string& paths) {
  if (!a || !b || (a->width == b->width && a->height == b->height)) return OkStatus();
  return DataLoss(
      fmt::format("{}: not of one scan: the {} camera has {} x {} pixels in one and {} x {} in the "
                  "other",
                  paths, sensor, a->width, a->height, b->width, b->height));
}

Status CheckSameCameras(const Rig& a, const Rig& b, const std::string& paths) {
  ISOTHERM_RETURN_IF_ERROR(CheckSameCamera("depth", a.depth, b.depth, paths));
  return CheckSameCamera("thermal", a.thermal, b.thermal, paths);
}

int KnownParts(const Rig& rig) {
  return (rig.depth ? 1 : 0) + (rig.thermal ? 1 : 0) + (rig.T_thermal_depth ? 1 : 0);
}

/// A recording with its next item.
struct Part {
  std::unique_ptr<RecordingReader> reader;
  std::optional<RecordedItem> head;
  std::optional<CaptureTime> place;  ///< The head's, among the items of all recordings.
};

/// Returns the place of an item after one at `before` in the same recording. Recordings are in the
/// order of their frames; what others say of their time need not be right, and must not hold up or
/// hurry on what follows.
CaptureTime PlaceOf(const RecordedItem& item, const std::optional<CaptureTime>& before) {
  const CaptureTime time = TimeOf(item);
  if (HeaderOf(item) != nullptr || !before) return time;
  return std::clamp(time, *before, *before + std::chrono::seconds(1));
}

class MergedReader final : public MergedRecording {
 public:
  explicit MergedReader(std::vector<Part> recordings, std::vector<MergedPart> parts)
      : recordings_(std::move(recordings)), parts_(std::move(parts)) {
    info_ = recordings_.front().reader->info();
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      Add(recordings_[i].reader->info());
      Advance(i);
    }
  }

  const RecordingInfo& info() const override { return info_; }
  const std::vector<MergedPart>& parts() const override { return parts_; }
  const Status& conflict() const override { return conflict_; }
  std::uint64_t missing() const override {
    std::uint64_t missing = 0;
    for (const auto& [kind, frames] : frames_) {
      if (!frames.empty())
        missing += frames.rbegin()->first - frames.begin()->first + 1 - frames.size();
    }
    return missing;
  }

  /// The first that knows the most: a camera may have come after a recording had ended.
  Result<Rig> ReadRig() override {
    Result<Rig> best = recordings_.front().reader->ReadRig();
    for (std::size_t i = 1; i < recordings_.size(); ++i) {
      Result<Rig> rig = recordings_[i].reader->ReadRig();
      if (rig && (!best || KnownParts(*rig) > KnownParts(*best))) best = std::move(rig);
    }
    return best;
  }

  Result<std::optional<RecordedItem>> Next() override {
    while (conflict_.ok()) {
      const std::optional<std::size_t> earliest = Earliest();
      if (!earliest) break;
      RecordedItem item = std::move(*recordings_[*earliest].head);
      Advance(*earliest);
      if (!IsNew(item, *earliest)) continue;
      Count(item, parts_[*earliest]);
      return std::optional<RecordedItem>(std::move(item));
    }
    return std::optional<RecordedItem>();
  }

  Status Seek(CaptureTime /*time*/) override {
    return FailedPrecondition("merged recordings are read once, from the beginning to the end");
  }

 private:
  void Add(const RecordingInfo& info) {
    info_.complete = info_.complete && info.complete;
    for (const auto& [topic, count] : info.messages_by_topic) {
      std::uint64_t& most = info_.messages_by_topic[topic];
      most = std::max(most, count);
    }
    for (const auto& [name, values] : info.metadata) info_.metadata.try_emplace(name, values);
    if (info.start && (!info_.start || *info.start < *info_.start)) info_.start = info.start;
    if (info.end && (!info_.end || *info.end > *info_.end)) info_.end = info.end;
  }

  void Advance(std::size_t recording) {
    Part& part = recordings_[recording];
    while (true) {
      Result<std::optional<RecordedItem>> item = part.reader->Next();
      if (item) {
        part.head = std::move(*item);
        if (part.head) part.place = PlaceOf(*part.head, part.place);
        return;
      }
      NoteDamaged(recording, item.error().message());
    }
  }

  void NoteDamaged(std::size_t recording, std::string_view why) {
    // A damaged recording may have thousands; all are counted.
    constexpr std::uint64_t kMaxTold = 10;
    MergedPart& part = parts_[recording];
    if (++part.damaged > kMaxTold) return;
    LOG(Convert, Warning) << part.path.string() << ": not read: " << why;
  }

  /// The first recording of those whose next item is the earliest. nullopt at the end.
  std::optional<std::size_t> Earliest() const {
    std::optional<std::size_t> earliest;
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      const std::optional<RecordedItem>& head = recordings_[i].head;
      if (head && (!earliest || recordings_[i].place < recordings_[*earliest].place)) earliest = i;
    }
    return earliest;
  }

  bool IsNew(RecordedItem& item, std::size_t recording) {
    if (auto* step = std::get_if<ClockStep>(&item)) return IsNewStep(*step);
    const FrameHeader* header = HeaderOf(item);
    if (header == nullptr) return IsNewEvent(item);
    if (session_.value_or(header->session) != header->session) {
      conflict_ = DataLoss(
          fmt::format("not of one scan: {} has frames of session {}, the others of session {}",
                      parts_[recording].path.string(), header->session, *session_));
      return false;
    }
    session_ = header->session;
    auto& frames = frames_[item.index()];
    const auto seen = frames.find(header->frame_number);
    if (seen == frames.end()) {
      if (const Status whole = CheckImage(item); !whole.ok()) {
        NoteDamaged(recording, whole.message());
        return false;
      }
      frames.emplace(header->frame_number, header->capture_time);
      return true;
    }
    if (seen->second != header->capture_time) {
      conflict_ = DataLoss(fmt::format(
          "not of one scan: {} frame {} was taken {:.6f} s apart in {} and the others",
          NameOf(item), header->frame_number, ToSeconds(header->capture_time - seen->second),
          parts_[recording].path.string()));
    }
    return false;
  }

  /// Rig and ground note a step of the clock at different times, and each file begins to count
  /// anew: what tells is where the clock is then.
  bool IsNewStep(ClockStep& step) {
    if (wall_minus_time_ == step.wall_minus_time) return false;
    step.step = step.wall_minus_time - wall_minus_time_.value_or(Nanoseconds(0));
    wall_minus_time_ = step.wall_minus_time;
    return true;
  }

  /// The same event has the same time in each recording, so that those of one time are enough.
  bool IsNewEvent(const RecordedItem& item) {
    const CaptureTime time = TimeOf(item);
    if (time != events_time_) events_.clear();
    events_time_ = time;
    return events_.insert(NameOf(item)).second;
  }

  static void Count(const RecordedItem& item, MergedPart& part) {
    if (std::holds_alternative<RecordedDepth>(item)) ++part.depth_frames;
    if (std::holds_alternative<RecordedThermal>(item)) ++part.thermal_frames;
  }

  std::vector<Part> recordings_;
  std::vector<MergedPart> parts_;
  RecordingInfo info_;
  Status conflict_;
  /// Capture times by frame number, for each kind of frame: 16 bytes a frame and what a map needs.
  std::map<std::size_t, std::map<std::uint64_t, CaptureTime>> frames_;
  std::optional<std::uint64_t> session_;
  std::optional<Nanoseconds> wall_minus_time_;  ///< After the last step of the clock.
  CaptureTime events_time_{};
  std::set<std::string> events_;  ///< Seen at that time.
};

}  // namespace

const FrameHeader* HeaderOf(const RecordedItem& item) {
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) return &depth->frame.header;
  if (const auto* thermal = std::get_if<RecordedThermal>(&item)) return &thermal->frame.header;
  return nullptr;
}

CaptureTime TimeOf(const RecordedItem& item) {
  struct Visitor {
    CaptureTime operator()(const RecordedDepth& depth) const {
      return depth.frame.header.capture_time;
    }
    CaptureTime operator()(const RecordedThermal& thermal) const {
      return thermal.frame.header.capture_time;
    }
    CaptureTime operator()(const NucEvent& event) const { return event.start; }
    CaptureTime operator()(const RecordedPose& pose) const { return pose.pose.time; }
    CaptureTime operator()(const ExternalOdometry& pose) const { return pose.time; }
    CaptureTime operator()(const RecordedLog& log) const { return log.time; }
    CaptureTime operator()(const ClockStep& step) const { return step.time; }
  };
  return std::visit(Visitor(), item);
}

Result<std::unique_ptr<MergedRecording>> MergedRecording::OpenAll(
    const std::vector<std::filesystem::path>& paths) {
  std::vector<Part> recordings;
  std::vector<MergedPart> parts;
  std::optional<Rig> rig;
  for (const std::filesystem::path& path : paths) {
    auto reader = RecordingReader::Open(path);
    if (!reader) return Err(reader.error());
    if (Result<Rig> own = (*reader)->ReadRig()) {
      const std::string both = paths.front().string() + ", " + path.string();
      if (rig) {
        if (Status same = CheckSameCameras(*rig, *own, both); !same.ok())
          return Err(std::move(same));
      } else {
        rig = std::move(*own);
      }
    }
    recordings.push_back({std::move(*reader), std::nullopt, std::nullopt});
    parts.push_back({.path = path});
  }
  return std::make_unique<MergedReader>(std::move(recordings), std::move(parts));
}

}  // namespace isotherm
