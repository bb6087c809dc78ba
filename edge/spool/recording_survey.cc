#include "edge/spool/recording_survey.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "common/recording/recording_topics.h"

namespace isotherm {

/// Says whose frame an item is, and which.
struct RecordingSurvey::FramePoint {
  Sensor sensor{};
  FramePlace place;
};

namespace {

using namespace std::chrono_literals;

/// The places of frames that are looked up: one per interval, and no more than so many in a file.
constexpr Nanoseconds kPlaceInterval = 10s;
constexpr std::int64_t kMaxPlacesInFile = 128;
/// Items that are read in search of a frame of each camera.
constexpr int kMaxItemsPerPlace = 512;
/// The end is read from here on: some chunks.
constexpr Nanoseconds kEndStretch = 2s;
/// The rate at the end is measured over this long at least.
constexpr Nanoseconds kMinRateTime = 200ms;

std::uint64_t CountOf(const RecordingInfo& info, Sensor sensor) {
  const std::string_view topic =
      sensor == Sensor::kDepth ? recording::kDepthTopic : recording::kThermalTopic;
  const auto count = info.messages_by_topic.find(std::string(topic));
  return count == info.messages_by_topic.end() ? 0 : count->second;
}

}  // namespace

RecordingSurvey::RecordingSurvey(RecordingReader& reader) : reader_(reader) {
  const RecordingInfo& info = reader_.info();
  if (!info.start || !info.end) return;
  const Nanoseconds interval =
      std::max(kPlaceInterval, (*info.end - *info.start) / kMaxPlacesInFile);
  for (CaptureTime time = *info.start; time <= *info.end; time += interval) AddPlaces(time);
  for (StreamSurvey& stream : streams_) {
    if (!stream.places.empty()) stream.last = stream.places.back();
  }
  NoteLast(*info.end - kEndStretch, CaptureTime::max());
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    StreamSurvey& stream = streams_.at(static_cast<std::size_t>(sensor));
    stream.frames = CountOf(info, sensor);
    // A camera that came so late that no place had a frame of it.
    if (stream.frames > 0 && stream.places.empty())
      NoteLast(*info.end - interval - kPlaceInterval, CaptureTime::max());
    if (stream.places.empty()) continue;
    // A camera that was lost before: its last frame is no further than an interval behind its last
    // place.
    const CaptureTime last_place = stream.places.back().time;
    if (stream.last.time < *info.end - kEndStretch)
      NoteLast(last_place, last_place + interval + kPlaceInterval);
    SetRate(stream);
  }
}

std::optional<RecordingSurvey::FramePoint> RecordingSurvey::NextFrame(int& items_left) {
  while (items_left-- > 0) {
    const Result<std::optional<RecordedItem>> item = reader_.Next();
    if (!item) continue;  // One message; the next may be right.
    if (!*item) break;
    if (const auto* depth = std::get_if<RecordedDepth>(&**item)) {
      const FrameHeader& header = depth->frame.header;
      return FramePoint{Sensor::kDepth, {header.frame_number, header.capture_time}};
    }
    if (const auto* thermal = std::get_if<RecordedThermal>(&**item)) {
      const FrameHeader& header = thermal->frame.header;
      return FramePoint{Sensor::kThermal, {header.frame_number, header.capture_time}};
    }
  }
  return std::nullopt;
}

void RecordingSurvey::AddPlaces(CaptureTime time) {
  if (!reader_.Seek(time).ok()) return;
  std::array<bool, 2> found{};
  int items_left = kMaxItemsPerPlace;
  while (!found[0] || !found[1]) {
    const std::optional<FramePoint> point = NextFrame(items_left);
    if (!point) return;
    const auto index = static_cast<std::size_t>(point->sensor);
    if (std::exchange(found.at(index), true)) continue;
    std::vector<FramePlace>& places = streams_.at(index).places;
    if (places.empty() || places.back().number < point->place.number)
      places.push_back(point->place);
  }
}

void RecordingSurvey::NoteLast(CaptureTime from, CaptureTime to) {
  if (!reader_.Seek(from).ok()) return;
  int items_left = std::numeric_limits<int>::max();
  while (const std::optional<FramePoint> point = NextFrame(items_left)) {
    if (point->place.time > to) return;
    StreamSurvey& stream = streams_.at(static_cast<std::size_t>(point->sensor));
    if (stream.places.empty()) stream.places.push_back(point->place);
    if (point->place.number >= stream.last.number) stream.last = point->place;
  }
}

void RecordingSurvey::SetRate(StreamSurvey& stream) const {
  const auto before = std::find_if(
      stream.places.rbegin(), stream.places.rend(),
      [&stream](const FramePlace& place) { return stream.last.time - place.time >= kMinRateTime; });
  if (before == stream.places.rend()) return;
  stream.rate_hz = static_cast<double>(stream.last.number - before->number) /
                   ToSeconds(stream.last.time - before->time);
}

}  // namespace isotherm
