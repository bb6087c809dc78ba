#include "edge/spool/interrupted_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "common/frame/sensor_name.h"
#include "common/recording/recording.h"
#include "common/recording/recording_parts.h"
#include "common/recording/recording_topics.h"
#include "edge/spool/kept_part.h"
#include "edge/spool/recording_listing.h"
#include "edge/spool/recording_metadata.h"
#include "edge/spool/recording_survey.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr std::array kSensors = {Sensor::kDepth, Sensor::kThermal};
/// Recordings that are opened in search of the rig's newest. Rigs that share a folder are few.
constexpr std::size_t kMaxOpened = 16;
/// More than any camera has; a stream whose rate is not known may have had it.
constexpr double kMaxRate_hz = 200.0;
constexpr std::uint64_t kSpareNumbers = 8;
/// A process that is killed has published this much at most that it has not recorded: half a
/// second, and as much again for a disk that is slow. Longer: the ground takes the numbers for a
/// jump.
constexpr Nanoseconds kMinPassed = 1s;

std::string ScanValue(const RecordingInfo& info, const char* key) {
  return MetadataText(info, kScanMetadata, key);
}

constexpr const char* kEdgeIdKey = "edge_id";
constexpr const char* kSessionKey = "session";
constexpr const char* kBegunKey = "process_begun_ns";
constexpr std::array kFirstNumberKeys = {"first_depth_frame", "first_thermal_frame"};

/// Returns the number there; 0 if it is none.
std::uint64_t NumberOf(const RecordingInfo& info, const char* key) {
  return MetadataNumber(info, kScanMetadata, key).value_or(0);
}

std::uint64_t SessionOf(const RecordingInfo& info) { return NumberOf(info, kSessionKey); }

ScanPart PartOf(const RecordingInfo& info) {
  // Times and numbers that cannot be are damage, and count for nothing.
  const auto number = [&info](const char* key, std::uint64_t max) {
    return NumberOf(info, key) <= max ? NumberOf(info, key) : 0;
  };
  return {
      ScanValue(info, kEdgeIdKey),
      SessionOf(info),
      CaptureTimeFromNanoseconds(
          static_cast<std::int64_t>(number(kBegunKey, recording::kMaxRecordedNanoseconds))),
      {number(kFirstNumberKeys[0], kMaxFrameNumber), number(kFirstNumberKeys[1], kMaxFrameNumber)}};
}

/// An opened file of a scan.
struct OpenPart {
  ListedRecording listed;
  std::unique_ptr<RecordingReader> reader;
};

/// Returns a file of the recording that the rig wrote last; nullopt if there is none, or none that
/// was written lately.
std::optional<OpenPart> OpenNewest(const std::vector<ListedRecording>& recordings,
                                   const std::string& edge_id, CaptureTime oldest) {
  std::size_t opened = 0;
  for (const ListedRecording& listed : recordings) {
    // Opening a file that breaks off takes time, also when nothing is gone on with.
    if (listed.WrittenAt() < oldest || opened++ == kMaxOpened) break;
    Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(listed.path);
    if (reader && ScanValue((*reader)->info(), kEdgeIdKey) == edge_id)
      return OpenPart{listed, std::move(*reader)};
  }
  return std::nullopt;
}

/// Returns the files of the recording that are of the same scan as `one` and can be read, that one
/// among them, the first one first.
std::vector<OpenPart> PartsOf(OpenPart one, const std::vector<ListedRecording>& recordings) {
  const std::uint64_t session = SessionOf(one.reader->info());
  std::vector<OpenPart> parts;
  for (const ListedRecording& listed : recordings) {
    // Opening a file that breaks off takes time: once is enough.
    if (listed.first != one.listed.first || listed.path == one.listed.path) continue;
    Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(listed.path);
    if (reader && SessionOf((*reader)->info()) == session)
      parts.push_back({listed, std::move(*reader)});
  }
  parts.push_back(std::move(one));
  std::ranges::sort(parts, {}, [](const OpenPart& part) { return part.listed.part; });
  return parts;
}

/// Returns what the cameras are said to give, frames per second; 0: it is not said.
double NominalRate(const RecordingInfo& info, Sensor sensor) {
  const auto cameras = info.metadata.find("cameras");
  if (cameras == info.metadata.end()) return 0.0;
  const auto mode = cameras->second.find(std::string(NameOf(sensor)) + "_mode");
  if (mode == cameras->second.end()) return 0.0;
  double rate_hz = 0.0;  // "640x480@30"
  const std::size_t at = mode->second.find('@');
  if (at == std::string::npos) return 0.0;
  const char* const end = mode->second.data() + mode->second.size();
  return std::from_chars(mode->second.data() + at + 1, end, rate_hz).ec == std::errc() ? rate_hz
                                                                                       : 0.0;
}

/// Enters what a file has, and what it says of cameras and calibration.
void AddTo(InterruptedScan& scan, const OpenPart& part) {
  const RecordingSurvey survey(*part.reader);
  const RecordingInfo& info = part.reader->info();
  for (const Sensor sensor : kSensors) {
    const auto index = static_cast<std::size_t>(sensor);
    const StreamSurvey& found = survey.Of(sensor);
    RecordedStream& stream = scan.streams.at(index);
    if (found.places.empty() || found.places.front().number < stream.next) continue;
    const std::uint64_t before = stream.next;
    stream.frames += found.frames;
    stream.next = std::min(found.last.number, kMaxFrameNumber) + 1;
    // A camera that was away for a part of the time has a lower rate than that of its frames.
    stream.rate_hz = std::max(found.rate_hz, NominalRate(info, sensor));
    scan.newest = std::max(scan.newest, found.last.time);
    // Before the first place there may be others; a run need not have all of its frames.
    const std::uint64_t first = PartOf(info).first_numbers.at(index);
    const bool has_earlier = first >= before && first < found.places.front().number && info.start;
    FramePlace place = has_earlier ? FramePlace{first, *info.start} : found.places.front();
    for (std::size_t i = has_earlier ? 0 : 1; i <= found.places.size(); ++i) {
      const std::uint64_t end = i < found.places.size() ? found.places[i].number : stream.next;
      scan.runs.push_back({part.listed.path, sensor, {place.number, end - 1}, place.time});
      if (i < found.places.size()) place = found.places[i];
    }
  }
  // The newest may have been left before anything but metadata was on the disk.
  if (Result<Rig> rig = part.reader->ReadRig()) scan.rig = std::move(*rig);
  scan.metadata = info.metadata;
}

/// Enters what the recording has had before its files that are left.
void AddBefore(InterruptedScan& scan, const RecordedBefore& before) {
  for (const Sensor sensor : kSensors) {
    const StreamBefore& had = before.at(static_cast<std::size_t>(sensor));
    RecordedStream& stream = scan.streams.at(static_cast<std::size_t>(sensor));
    stream.frames = had.frames;
    stream.next = stream.deleted = had.next;
  }
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
    const double passed_s = std::max(ToSeconds(kMinPassed), ToSeconds(now - since));
    return number + kSpareNumbers + static_cast<std::uint64_t>(std::ceil(rate_hz * passed_s));
  };
  const std::uint64_t by_frames = later(stream.next, newest);
  // The newest process may have been killed before it had recorded anything.
  const std::uint64_t first = last.first_numbers.at(static_cast<std::size_t>(sensor));
  return first > stream.next ? std::max(by_frames, later(first, last.begun)) : by_frames;
}

std::optional<InterruptedScan> FindInterruptedScan(const std::string& record,
                                                   const std::string& edge_id, CaptureTime now,
                                                   Nanoseconds max_age) {
  if (max_age <= Nanoseconds(0) || IsDevice(record)) return std::nullopt;
  const std::vector<ListedRecording> recordings = ListRecordings(record);
  std::optional<OpenPart> found = OpenNewest(recordings, edge_id, now - max_age);
  if (!found || SessionOf(found->reader->info()) == 0) return std::nullopt;
  // Which part was written last says nothing: others may have been completed since.
  const std::vector<OpenPart> parts = PartsOf(std::move(*found), recordings);
  const RecordingInfo& newest = parts.back().reader->info();
  const bool has_ended = (newest.complete && !GoesOn(newest)) ||
                         parts.back().listed.WrittenAt() < now - max_age ||
                         IsBeingWritten(parts.back().listed.path);
  if (has_ended) return std::nullopt;

  InterruptedScan scan;
  scan.last = PartOf(parts.back().reader->info());
  scan.path = parts.back().listed.first;
  scan.parts = parts.back().listed.part;
  if (const auto before = ReadRecordedBefore(parts.front().reader->info()))
    AddBefore(scan, *before);
  for (const OpenPart& part : parts) AddTo(scan, part);
  const std::uint64_t next = std::max(scan.Of(Sensor::kDepth).next, scan.Of(Sensor::kThermal).next);
  if (next == 0) return std::nullopt;
  if (next > kMaxFrameNumber || now < scan.newest) {
    LOG(Spool, Warning) << scan.path.string() << " was interrupted, and is not gone on with: "
                        << (next > kMaxFrameNumber
                                ? "its frame numbers cannot be"
                                : "the clock was set back since its newest frame");
    return std::nullopt;
  }
  return scan;
}

}  // namespace isotherm
