#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/recording/recording.h"
#include "edge/spool/spool.h"

namespace isotherm {

/// Holds what a FakeRecordingWriter was given; outlives the writer.
struct FakeRecording {
  std::vector<std::uint64_t> depth_frames;
  std::vector<std::uint64_t> thermal_frames;
  std::vector<Rig> rigs;
  std::vector<NucEvent> nuc_events;
  std::vector<ClockStep> clock_steps;
  std::vector<ExternalOdometry> external_odometry;
  std::vector<std::pair<std::string, CaptureTime>> messages;  ///< By topic.
  std::vector<RecordedLog> log;
  int writes_after_failure = 0;
  std::atomic<int> flushes = 0;
  std::uint64_t bytes = 0;             ///< The writer reports this size.
  std::function<void()> before_frame;  ///< Called on the thread that records, if set.
  bool refuse_next = false;            ///< The next frame is not one that can be recorded.
  bool closed = false;
};

/// A disk with room for this many frames. Thread-compatible.
class FakeRecordingWriter final : public RecordingWriter {
 public:
  explicit FakeRecordingWriter(FakeRecording& recording, std::uint64_t room = UINT64_MAX)
      : recording_(recording), room_(room) {}

  Status Write(const Rig& rig) override {
    recording_.rigs.push_back(rig);
    return OkStatus();
  }
  Status Write(const EncodedDepthFrame& frame, const std::optional<CaptureTime>&) override {
    return Take(frame.header.frame_number, recording_.depth_frames);
  }
  Status Write(const EncodedThermalFrame& frame, const std::optional<CaptureTime>&) override {
    return Take(frame.header.frame_number, recording_.thermal_frames);
  }
  Status Write(const NucEvent& event) override {
    recording_.nuc_events.push_back(event);
    return OkStatus();
  }
  Status Write(const ClockStep& step) override {
    recording_.clock_steps.push_back(step);
    return OkStatus();
  }
  Status Write(const ExternalOdometry& pose) override {
    recording_.external_odometry.push_back(pose);
    return OkStatus();
  }
  Status WritePose(std::string_view, const StampedPose&) override { return OkStatus(); }
  Status WriteMetadata(std::string_view, const std::map<std::string, std::string>&) override {
    return OkStatus();
  }
  Status WriteLog(CaptureTime time, std::string_view level, std::string_view text) override {
    recording_.log.push_back({time, std::string(level), std::string(text)});
    return OkStatus();
  }
  Status WriteMessage(std::string_view topic, std::string_view, std::string_view, CaptureTime time,
                      std::string_view) override {
    recording_.messages.emplace_back(topic, time);
    return OkStatus();
  }
  Status Flush() override {
    ++recording_.flushes;
    return OkStatus();
  }
  Status Close() override {
    recording_.closed = true;
    return OkStatus();
  }
  RecordingStats stats() const override {
    return {recording_.depth_frames.size(), recording_.thermal_frames.size(), failed_,
            recording_.bytes};
  }

 private:
  Status Take(std::uint64_t frame_number, std::vector<std::uint64_t>& frames) {
    if (recording_.before_frame) recording_.before_frame();
    if (std::exchange(recording_.refuse_next, false)) return InvalidArgument("no such frame");
    if (room_ == 0) {
      if (failed_++ > 0) ++recording_.writes_after_failure;
      return IoError("no space left on device");
    }
    --room_;
    frames.push_back(frame_number);
    return OkStatus();
  }

  FakeRecording& recording_;
  std::uint64_t room_;
  std::uint64_t failed_ = 0;
};

/// A spool that records to `recording`, in one file.
inline std::unique_ptr<Spool> MakeFakeSpool(FakeRecording& recording, const SpoolOptions& options,
                                            const Clock& clock, FrameCounters& counters,
                                            std::uint64_t room = UINT64_MAX) {
  return std::make_unique<Spool>(SpoolParts{
      [&recording, room]() -> Result<RecordingFile> {
        return RecordingFile{"scan.mcap", std::make_unique<FakeRecordingWriter>(recording, room)};
      },
      [] { return std::uint64_t{0}; }, options, clock, counters});
}

}  // namespace isotherm
