#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "tests/support/departure.h"
#include "tests/support/programs.h"
#include "tests/support/small_scan.h"

namespace isotherm::system_test {

/// As in the shipped unit.
inline constexpr const char* kWatchdog = "WATCHDOG_USEC=10000000";
inline constexpr Seconds kWatchdogSec{10};
inline constexpr const char* kFed = "WATCHDOG=1";
/// The daemon gives this to a disk that does not answer (kDisk of stop_limits).
inline constexpr Seconds kForTheDisk{3.5};

/// How often `words` stand in `text`.
inline int Count(const std::string& text, const std::string& words) {
  int count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
    ++count;
  return count;
}

/// An edge with its disk and its cameras; the test plays the service manager.
class EdgeFailureTest : public ::testing::Test {
 protected:
  EdgeFailureTest() { WriteSmallScan(scan_); }

  Command Edge(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(OwnDomain())});
    return {EdgeDaemon(),
            std::move(arguments),
            {"LD_LIBRARY_PATH=" FAKE_OPENNI, manager_.environment(), kWatchdog},
            {}};
  }
  Command OnCameras(std::vector<std::string> more) const {
    // The fake camera's script lies in the test's folder, which its confined process may read.
    std::vector<std::string> arguments = {
        "--source", "cameras",
        "--set",    "source.thermal_camera.enabled=false",
        "--set",    "source.camera_sandbox.expert.read=\"" + folder_.path().string() + "\"",
        "--set",    "source.camera_sandbox.expert.read=\"" + camera_.folder().string() + "\""};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Edge(std::move(arguments));
  }
  /// A scan that goes on until the end of the test.
  Command Replay(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"--recording", scan_.string(), "--set", "source.loops=0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Edge(std::move(arguments));
  }
  /// Ends it, which takes no longer than `limit` unless others have the processors.
  static Departure ExpectToLeave(Process& edge, int status, Seconds limit = kTimeToLeave) {
    const Departure departure = Leave(edge, SIGTERM, kPatience);
    EXPECT_EQ(departure.status, status) << edge.output();
    EXPECT_LT(departure.own(), limit) << departure.ToText() << edge.output();
    return departure;
  }
  static std::vector<std::filesystem::path> FilesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }
  bool WaitForSize(Process& edge, const std::filesystem::path& file, std::uintmax_t bytes) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    std::error_code missing;
    while (!std::filesystem::exists(file) || std::filesystem::file_size(file, missing) < bytes) {
      manager_.Drain();
      if (edge.WaitForExit(Seconds(0.05))) return false;
      if (std::chrono::steady_clock::now() > deadline) return false;
    }
    return true;
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  NotifySocket manager_{folder_.path()};
  FakeDepthCamera camera_;
  const std::filesystem::path scan_ = folder_.path() / "scan.mcap";
  const std::filesystem::path disk_ = folder_.path() / "disk";
  const std::filesystem::path file_ = disk_ / "copy.mcap";
};

}  // namespace isotherm::system_test
