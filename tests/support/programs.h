#pragma once

#include <google/protobuf/struct.pb.h>

#include <filesystem>
#include <string>
#include <vector>

#include "common/recording/recording.h"
#include "tests/support/process.h"

namespace isotherm::system_test {

/// The programs of this build.
std::filesystem::path Tool();
std::filesystem::path EdgeDaemon();
std::filesystem::path GroundService();

/// The DDS domain of this test process, which no other one on this computer has: programs of other
/// tests are not met.
int OwnDomain();

/// Far more than any program needs here: a limit for hanging, not a requirement.
inline constexpr Seconds kPatience{240};

/// Options of a coarse, quick model.
std::vector<std::string> QuickModel();
/// The same for what does not ask how the cameras are calibrated: that is not checked at the end,
/// which takes several times as long as a short scan.
std::vector<std::string> QuickScan();

/// Renders a short simulated scan: 640 x 480 depth and 382 x 288 thermal frames of a corner with a
/// sphere. Fails the running test if that does not work.
void SimulateScan(const std::filesystem::path& path, double duration_s);

/// stats.json of a result folder. Fails the running test if it is not JSON.
google::protobuf::Struct ReadStats(const std::filesystem::path& folder);
/// The number at `path` ("link", "depth", "received"); fails the running test and gives NaN if
/// there is none.
double NumberAt(const google::protobuf::Struct& json, const std::vector<std::string>& path);

/// Holds what a recorded frame is, however it is stored.
struct StoredFrame {
  Sensor sensor = Sensor::kDepth;
  std::uint64_t frame_number = 0;
  CaptureTime capture_time{};
  std::vector<std::uint16_t> pixels;
  friend bool operator==(const StoredFrame&, const StoredFrame&) = default;
};

/// Holds the frames that a recording kept.
struct RecordingContent {
  bool complete = false;
  std::vector<StoredFrame> depth;    ///< By frame number.
  std::vector<StoredFrame> thermal;  ///< By frame number.
};

/// All frames of a recording. Fails the running test if it cannot be read.
RecordingContent ReadRecording(const std::filesystem::path& path);

/// The numbers of a line of the edge's summary: "depth    captured 100 = recorded 99 + rejected 1 +
/// queue full 0 + failed 0".
struct FrameCountersText {
  long captured = -1, done = -1, rejected = -1, queue_full = -1, failed = -1;
  long left_out = 0;  ///< " + no free slot in the camera's process 3"; not there: none.
  bool Closes() const {
    return captured >= 0 && captured == done + rejected + queue_full + failed + left_out;
  }
};
/// `done`: "recorded" or "published". Counters that do not balance if there is no such line, or
/// if it speaks of unaccounted frames.
FrameCountersText CountersOf(const std::string& output, Sensor sensor, const std::string& done);

/// "depth    lost in the camera or its library 3"; 0 if there is no such line.
long LostInCamera(const std::string& output, Sensor sensor);

}  // namespace isotherm::system_test
