#include "edge/spool/interrupted_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "common/recording/recording.h"
#include "common/recording/recording_parts.h"
#include "common/recording/recording_topics.h"
#include "edge/spool/recording_listing.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr std::array kSensors = {Sensor::kDepth, Sensor::kThermal};
/// Recordings that are opened in search of the rig's newest. Rigs that share a folder are few.
constexpr std::size_t kMaxOpened = 16;
/// The places of frames that are looked up: one per interval, and no more than so many in a file.
constexpr Nanoseconds kPlaceInterval = 10s;
constexpr std::int64_t kMaxPlacesInFile = 128;
/// Items that are read in search of a frame of each camera.
constexpr int kMaxItemsPerPlace = 512;
/// More than any camera has; a stream whose rate is not known may have had it.
constexpr double kMaxRate_hz = 200.0;
/// The rate at the end is measured over this long at least.
constexpr Nanoseconds kMinRateTime = 200ms;
constexpr std::uint64_t kSpareNumbers = 8;

/// Returns the value of the scan's metadata; empty if there is none.
std::string ScanValue(const RecordingInfo& info, const char* key) {
  const auto scan = info.metadata.find(std::string(kScanMetadata));
  if (scan == info.metadata.end()) return {};
  const auto value = scan->second.find(key);
  return value == scan->second.end() ? std::string() : value->second;
}

constexpr const char* kEdgeIdKey = "edge_id";
constexpr const char* kSessionKey = "session";
constexpr const char* kBegunKey = "process_begun_ns";
constexpr std::array kFirstNumberKeys = {"first_depth_frame", "first_thermal_frame"};

/// Returns the number there; 0 if it is none.
std::uint64_t NumberOf(const RecordingInfo& info, const char* key) {
  const std::string text = ScanValue(info, key);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

std::uint64_t SessionOf(const RecordingInfo& info) { return NumberOf(info, kSessionKey); }

ScanPart PartOf(const RecordingInfo& info) {
  // Times and numbers that cannot be are damage, and count for nothing.
  constexpr std::uint64_t kMaxNumber = std::uint64_t{1} << 62U;
  const auto number = [&info](const char* key) {
    return NumberOf(info, key) <= kMaxNumber ? NumberOf(info, key) : 0;
  };
  return {ScanValue(info, kEdgeIdKey),
          SessionOf(info),
          CaptureTimeFromNanoseconds(static_cast<std::int64_t>(number(kBegunKey))),
          {number(kFirstNumberKeys[0]), number(kFirstNumberKeys[1])}};
}

std::uint64_t CountOf(const RecordingInfo& info, Sensor sensor) {
  const std::string_view topic =
      sensor == Sensor::kDepth ? recording::kDepthTopic : recording::kThermalTopic;
  const auto count = info.messages_by_topic.find(std::string(topic));
  return count == info.messages_by_topic.end() ? 0 : count->second;
}

/// Says whose frame an item is, and which.
struct FramePoint {
  Sensor sensor{};
  std::uint64_t number = 0;
  CaptureTime time{};
};

std::optional<FramePoint> PointOf(const RecordedItem& item) {
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) {
    const FrameHeader& header = depth->frame.header;
    return FramePoint{Sensor::kDepth, header.frame_number, header.capture_time};
  }
  if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
    const FrameHeader& header = thermal->frame.header;
    return FramePoint{Sensor::kThermal, header.frame_number, header.capture_time};
  }
  return std::nullopt;
}

/// Finds out which frames one file has, by samples, and exactly at the end of each stream.
class FileSurvey {
 public:
  FileSurvey(std::filesystem::path path, RecordingReader& reader)
      : path_(std::move(path)), reader_(reader) {
    const RecordingInfo& info = reader_.info();
    if (!info.start || !info.end) return;
    const Nanoseconds length = *info.end - *info.start;
    const Nanoseconds interval = std::max(kPlaceInterval, length / kMaxPlacesInFile);
    for (CaptureTime time = *info.start; time <= *info.end; time += interval) AddPlaces(time);
    for (const Sensor sensor : kSensors) FindEnd(sensor, interval);
  }

  /// Enters what was found.
  void AddTo(InterruptedScan& scan) const {
    for (const Sensor sensor : kSensors) {
      const auto index = static_cast<std::size_t>(sensor);
      const std::vector<FramePoint>& places = places_[index];
      RecordedStream& stream = scan.streams[index];
      if (places.empty() || places.front().number < stream.next) continue;
      stream.frames += CountOf(reader_.info(), sensor);
      stream.next = last_[index].number + 1;
      if (rate_hz_[index] > 0.0) stream.rate_hz = rate_hz_[index];
      scan.newest = std::max(scan.newest, last_[index].time);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const std::uint64_t end = i + 1 < places.size() ? places[i + 1].number : stream.next;
        scan.runs.push_back({path_, sensor, {places[i].number, end - 1}, places[i].time});
      }
    }
  }

 private:
  /// Returns the next frame; nullopt at the end, and where the file cannot be read.
  std::optional<FramePoint> NextFrame(int& items_left) {
    while (items_left-- > 0) {
      const Result<std::optional<RecordedItem>> item = reader_.Next();
      if (!item) continue;  // One message; the next may be right.
      if (!*item) break;
      if (const std::optional<FramePoint> point = PointOf(**item)) return point;
    }
    return std::nullopt;
  }

  /// Notes the first frame of each stream from `time` on.
  void AddPlaces(CaptureTime time) {
    if (!reader_.Seek(time).ok()) return;
    std::array<bool, 2> found{};
    int items_left = kMaxItemsPerPlace;
    while (!found[0] || !found[1]) {
      const std::optional<FramePoint> point = NextFrame(items_left);
      if (!point) return;
      const auto index = static_cast<std::size_t>(point->sensor);
      if (std::exchange(found[index], true)) continue;
      std::vector<FramePoint>& places = places_[index];
      if (places.empty() || places.back().number < point->number) places.push_back(*point);
    }
  }

  /// Finds the last frame of a stream, which lies no further than an interval behind its last
  /// place, and the rate there.
  void FindEnd(Sensor sensor, Nanoseconds interval) {
    const auto index = static_cast<std::size_t>(sensor);
    if (places_[index].empty()) return;
    const FramePoint first = places_[index].back();
    last_[index] = first;
    if (!reader_.Seek(first.time).ok()) return;
    int items_left = std::numeric_limits<int>::max();
    while (const std::optional<FramePoint> point = NextFrame(items_left)) {
      if (point->time > first.time + interval + kPlaceInterval) break;
      if (point->sensor == sensor && point->number > last_[index].number) last_[index] = *point;
    }
    const FramePoint& last = last_[index];
    const auto before = std::find_if(
        places_[index].rbegin(), places_[index].rend(),
        [&](const FramePoint& place) { return last.time - place.time >= kMinRateTime; });
    if (before == places_[index].rend()) return;
    rate_hz_[index] =
        static_cast<double>(last.number - before->number) / ToSeconds(last.time - before->time);
  }

  const std::filesystem::path path_;
  RecordingReader& reader_;
  // By Sensor.
  std::array<std::vector<FramePoint>, 2> places_;  ///< Ascending.
  std::array<FramePoint, 2> last_{};
  std::array<double, 2> rate_hz_{};
};

/// Returns the rig's newest recording; nullptr if there is none.
std::unique_ptr<RecordingReader> OpenNewest(const std::vector<ListedRecording>& candidates,
                                            const std::string& edge_id, ListedRecording& newest) {
  for (std::size_t i = 0; i < std::min(candidates.size(), kMaxOpened); ++i) {
    Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(candidates[i].path);
    if (!reader || ScanValue((*reader)->info(), kEdgeIdKey) != edge_id) continue;
    newest = candidates[i];
    return std::move(*reader);
  }
  return nullptr;
}

/// An opened file of a scan.
struct Part {
  std::filesystem::path path;
  std::unique_ptr<RecordingReader> reader;
};

/// Returns the files of the scan that can be read, the first one first.
std::vector<Part> PartsOf(const InterruptedScan& scan, std::vector<ListedRecording> candidates) {
  std::ranges::sort(candidates, {}, &ListedRecording::part);
  std::vector<Part> parts;
  for (const ListedRecording& candidate : candidates) {
    if (candidate.first != scan.path || candidate.part > scan.parts) continue;
    Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(candidate.path);
    if (reader && SessionOf((*reader)->info()) == scan.last.session)
      parts.push_back({candidate.path, std::move(*reader)});
  }
  return parts;
}

}  // namespace

std::map<std::string, std::string> ToMetadata(const ScanPart& part) {
  std::map<std::string, std::string> metadata = {
      {kEdgeIdKey, part.edge_id},
      {kSessionKey, fmt::format("{}", part.session)},
      {kBegunKey, fmt::format("{}", ToNanoseconds(part.begun))}};
  for (std::size_t i = 0; i < kFirstNumberKeys.size(); ++i)
    metadata[kFirstNumberKeys.at(i)] = fmt::format("{}", part.first_numbers.at(i));
  return metadata;
}

std::uint64_t InterruptedScan::NextNumber(Sensor sensor, CaptureTime now) const {
  const RecordedStream& stream = Of(sensor);
  const double rate_hz =
      stream.rate_hz > 0.0 ? std::min(stream.rate_hz, kMaxRate_hz) : kMaxRate_hz / 2.0;
  const auto later = [&](std::uint64_t number, CaptureTime since) {
    const double passed_s = std::max(0.0, ToSeconds(now - since));
    return number + kSpareNumbers + static_cast<std::uint64_t>(std::ceil(rate_hz * passed_s));
  };
  const std::uint64_t by_frames = later(stream.next, newest);
  // The newest process may have been killed before it had recorded anything.
  const std::uint64_t first = last.first_numbers[static_cast<std::size_t>(sensor)];
  return first > stream.next ? std::max(by_frames, later(first, last.begun)) : by_frames;
}

std::optional<InterruptedScan> FindInterruptedScan(const std::string& record,
                                                   const std::string& edge_id, CaptureTime now,
                                                   Nanoseconds max_age) {
  if (record == "off" || max_age <= Nanoseconds(0) || IsDevice(record)) return std::nullopt;
  const std::vector<ListedRecording> candidates = ListRecordings(record);
  ListedRecording newest;
  const std::unique_ptr<RecordingReader> reader = OpenNewest(candidates, edge_id, newest);
  if (reader == nullptr || reader->info().complete || IsBeingWritten(newest.path))
    return std::nullopt;
  InterruptedScan scan;
  scan.last = PartOf(reader->info());
  scan.path = newest.first;
  scan.parts = newest.part;
  scan.metadata = reader->info().metadata;
  if (Result<Rig> rig = reader->ReadRig()) scan.rig = std::move(*rig);
  if (scan.last.session == 0) return std::nullopt;

  const std::vector<Part> parts = PartsOf(scan, candidates);
  std::optional<CaptureTime> end;
  for (const Part& part : parts) {
    const std::optional<CaptureTime>& of_part = part.reader->info().end;
    if (of_part) end = std::max(end.value_or(*of_part), *of_part);
  }
  // Before the survey, which takes time.
  if (!end || now < *end || now - *end > max_age) return std::nullopt;
  for (const Part& part : parts) FileSurvey(part.path, *part.reader).AddTo(scan);
  const bool has_frames = scan.Of(Sensor::kDepth).next + scan.Of(Sensor::kThermal).next > 0;
  if (!has_frames || now < scan.newest) return std::nullopt;
  return scan;
}

}  // namespace isotherm
