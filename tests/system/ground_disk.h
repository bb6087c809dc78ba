#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {

inline constexpr double kScan_s = 2.0;
inline constexpr ExitStatus kDiskFull = 73;
inline constexpr ExitStatus kDiskStuck = 74;

/// Holds a ground with a folder of its own, and edges that play a short scan to it.
class GroundDiskTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<testing::TemporaryDirectory>();
    SimulateScan(Source(), kScan_s);
  }
  static void TearDownTestSuite() { shared_.reset(); }
  static std::filesystem::path Source() { return shared_->path() / "source.mcap"; }

  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }

  /// As fast as the ground takes it, or at another rate.
  static Command Edge(int loops, const std::string& rate = "0") {
    Command edge = EndlessEdge();
    edge.arguments.insert(edge.arguments.end(),
                          {"--rate", rate, "--wait-for-ground", "--exit-at-end", "--set",
                           "source.loops=" + std::to_string(loops)});
    return edge;
  }
  /// As a camera would.
  static Command EndlessEdge() {
    return {EdgeDaemon(),
            {"--recording", Source(), "--domain", std::to_string(OwnDomain()), "--set",
             "source.loops=0"},
            {}};
  }
  Command Ground(const std::vector<std::string>& more = {}) const {
    Command ground{
        GroundService(), {"--domain", std::to_string(OwnDomain()), "--output", Path("ground")}, {}};
    const std::vector<std::string> quick = QuickScan();
    ground.arguments.insert(ground.arguments.end(), quick.begin(), quick.end());
    ground.arguments.insert(ground.arguments.end(), more.begin(), more.end());
    return ground;
  }

  /// A recording that never gets anywhere: nobody opens the other end.
  void PutPipeInPlaceOfTheRecording() const {
    std::filesystem::create_directories(Path("ground"));
    ASSERT_EQ(mkfifo(Path("ground/scan.mcap").c_str(), 0600), 0);
  }

  /// Each frame that arrived is recorded, or the reason is known why not.
  static void ExpectEachFrameAccountedFor(const google::protobuf::Struct& stats,
                                          const char* sensor) {
    double not_recorded = 0.0;
    const auto& stream = stats.fields().at("link").struct_value().fields().at(sensor);
    const auto& fields = stream.struct_value().fields();
    if (fields.contains("not_recorded_by_reason")) {
      for (const auto& [reason, frames] :
           fields.at("not_recorded_by_reason").struct_value().fields())
        not_recorded += frames.number_value();
    }
    EXPECT_EQ(NumberAt(stats, {"link", sensor, "recorded"}) + not_recorded,
              NumberAt(stats, {"link", sensor, "received"}))
        << sensor;
  }

  /// Everything that was published arrived and was reconstructed; of the recording, all is known.
  static void ExpectWholeCounters(const google::protobuf::Struct& stats, const char* sensor) {
    const auto count = [&](const std::string& what) {
      return NumberAt(stats, {"link", sensor, what});
    };
    EXPECT_GT(count("published"), 0) << sensor;
    EXPECT_EQ(count("received"), count("published")) << sensor;
    EXPECT_EQ(count("missing"), 0) << sensor;
    EXPECT_EQ(NumberAt(stats, {"frames", sensor, "in"}), count("received")) << sensor;
    ExpectEachFrameAccountedFor(stats, sensor);
  }

  static inline std::unique_ptr<testing::TemporaryDirectory> shared_;
  const testing::TemporaryDirectory folder_;
};

}  // namespace isotherm::system_test
