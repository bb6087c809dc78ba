#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/geometry/external_odometry.h"
#include "common/geometry/stamped_pose.h"
#include "common/rig/rig.h"
#include "common/time/clock.h"

namespace isotherm {

/// The shutter closed or opened (from the camera, the supervisor or a data set).
struct NucEvent {
  CaptureTime start;
  CaptureTime end;
  NucSource source = NucSource::kUnknown;
};

/// The wall clock was set during the scan, which capture times do not follow.
struct ClockStep {
  CaptureTime time{};              ///< Capture time of the first frame after it.
  Nanoseconds step{0};             ///< Positive = ahead.
  Nanoseconds wall_minus_time{0};  ///< Added to capture times from here on, it gives UTC.
};

/// Tells how images are stored. kViewable stores foxglove.RawImage and the place of the thermal
/// camera as a transform, so that Foxglove and Lichtblick show the scan. kCompact stores our
/// lossless codes in messages that are field-compatible with foxglove.CompressedImage (about a
/// third smaller).
enum class ImageStorage { kViewable, kCompact };

/// Says how a recording is stored.
struct RecordingOptions {
  ImageStorage image_storage = ImageStorage::kCompact;
  std::size_t chunk_bytes = 4U << 20;  ///< A chunk is closed when it holds this much.
  Nanoseconds flush_interval =
      std::chrono::milliseconds(500);  ///< A chunk is closed at this age (capture time), <= 1 s.
  /// fdatasync after each chunk, so that a power cut costs at most the last; less often while the
  /// disk is slow in that.
  bool sync = true;
  /// Measures how slow (mcap::WriterOptions); nullptr: after each chunk, however slow. Must outlive
  /// the writer.
  const Clock* clock = nullptr;
};

/// Counters: written + failed = offered.
struct RecordingStats {
  std::uint64_t depth_frames = 0;
  std::uint64_t thermal_frames = 0;
  std::uint64_t failed = 0;
  std::uint64_t bytes = 0;
  std::uint64_t unsynced = 0;  ///< Part of `failed`: the disk took these but did not confirm them.
};

/// Writes a scan as MCAP: chunks with zstd and CRC, message indexes, a summary at the end. The file
/// grows under its final name and is readable up to the last flushed chunk at any time. After an
/// I/O error (disk full) the writer keeps what is good, reports the error once per call and writes
/// nothing more. Thread-compatible.
class RecordingWriter {
 public:
  /// Creates `path` (parent directories too); refuses to overwrite an existing file.
  static Result<std::unique_ptr<RecordingWriter>> Create(const std::filesystem::path& path,
                                                         const RecordingOptions& options);
  virtual ~RecordingWriter() = default;

  /// A rig that follows another one holds for the whole recording: a camera that came late is in
  /// it.
  virtual Status Write(const Rig& rig) = 0;
  virtual Status Write(const EncodedDepthFrame& frame,
                       const std::optional<CaptureTime>& arrival) = 0;
  virtual Status Write(const EncodedThermalFrame& frame,
                       const std::optional<CaptureTime>& arrival) = 0;
  virtual Status Write(const NucEvent& event) = 0;
  virtual Status Write(const ClockStep& step) = 0;
  /// As it came, right or wrong; written as foxglove.PoseInFrame.
  virtual Status Write(const ExternalOdometry& pose) = 0;
  /// `stream`: "groundtruth" or "trajectory"; written as foxglove.FrameTransform world -> depth.
  virtual Status WritePose(std::string_view stream, const StampedPose& pose) = 0;
  /// Free text kept as MCAP metadata: `configuration`, `software`, `origin`, ...
  virtual Status WriteMetadata(std::string_view name,
                               const std::map<std::string, std::string>& values) = 0;
  virtual Status WriteLog(CaptureTime time, std::string_view level, std::string_view text) = 0;
  /// Any further protobuf message under its own topic (feedback, status): `schema` is the
  /// FileDescriptorSet.
  virtual Status WriteMessage(std::string_view topic, std::string_view schema_name,
                              std::string_view schema, CaptureTime time,
                              std::string_view payload) = 0;
  /// Closes the current chunk and hands it to the operating system.
  virtual Status Flush() = 0;
  /// Writes index, summary and footer. Idempotent; the destructor calls it.
  virtual Status Close() = 0;
  virtual RecordingStats stats() const = 0;
};

/// Holds a frame and when it arrived where it was recorded; nullopt: the recording does not say.
struct RecordedDepth {
  EncodedDepthFrame frame;
  std::optional<CaptureTime> arrival;
};
/// The same for a thermal frame.
struct RecordedThermal {
  EncodedThermalFrame frame;
  std::optional<CaptureTime> arrival;
};
/// Holds a pose of one of the streams "groundtruth" and "trajectory".
struct RecordedPose {
  std::string stream;
  StampedPose pose;
};
/// Begins the text of a RecordedLog that marks a moment; what somebody called it follows.
inline constexpr const char* kMarkPrefix = "mark: ";
/// A sentence about something that happened during the scan.
struct RecordedLog {
  CaptureTime time{};
  std::string level{};  ///< debug, info, warning or error.
  std::string text{};
};
using RecordedItem = std::variant<RecordedDepth, RecordedThermal, NucEvent, RecordedPose,
                                  ExternalOdometry, RecordedLog, ClockStep>;

/// A part of the file that is damaged or was never finished.
struct RecordingGap {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  /// Messages that were in it, as far as what is left of the file tells.
  std::map<std::string, std::uint64_t> messages_by_topic;
};

/// Holds what is known about a recording without reading its frames (from the summary, or rebuilt
/// by one pass over the chunk headers if the file has none).
struct RecordingInfo {
  bool complete = false;            ///< Has footer and summary.
  std::uint64_t bytes_ignored = 0;  ///< Damaged or unfinished parts that are not read.
  std::vector<RecordingGap> gaps;   ///< Where these are; the first thousand.
  std::map<std::string, std::uint64_t> messages_by_topic;
  std::optional<CaptureTime> start, end;
  std::map<std::string, std::map<std::string, std::string>> metadata;
};

/// Reads scans back in the order of log time within bounded memory (a chunk or two at a time). Of a
/// truncated or damaged file all good chunks are read. Thread-compatible.
class RecordingReader {
 public:
  static Result<std::unique_ptr<RecordingReader>> Open(const std::filesystem::path& path);
  virtual ~RecordingReader() = default;

  virtual const RecordingInfo& info() const = 0;
  /// The rig calibration: the last one that was written, or if it cannot be read the first that
  /// can; kNotFound if there is none.
  virtual Result<Rig> ReadRig() = 0;
  /// Next item in log-time order; nullopt at the end. kDataLoss for a message that cannot be read:
  /// the next call goes on behind it. kResourceExhausted once, before the end, if the file takes
  /// far more work than its size justifies.
  virtual Result<std::optional<RecordedItem>> Next() = 0;
  /// Starts again at the first item at or after `time`.
  virtual Status Seek(CaptureTime time) = 0;
};

}  // namespace isotherm
