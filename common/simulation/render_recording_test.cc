#include "common/simulation/render_recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stop_token>
#include <vector>

#include "common/codec/codec.h"
#include "common/options/text_proto.h"
#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "common/simulation/options.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

/// A scan of 1.2 s with small renderings: 36 depth and 48 thermal frames.
class RenderRecordingTest : public ::testing::Test {
 protected:
  RenderRecordingTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    dir_ = fs::temp_directory_path() /
           (std::string("isotherm_render_") + test->name() + "_" + std::to_string(getpid()));
    fs::remove_all(dir_);
    fs::create_directories(dir_);
    Rig rig = DefaultSimulatedRig();
    rig.depth = rig.depth->Downscaled(3);
    rig.thermal = rig.thermal->Downscaled(2);
    std::ofstream(dir_ / "rig.textproto") << ToText(rig);
    options_.set_rig_file(dir_ / "rig.textproto");
    options_.set_duration_s(1.2);
    options_.mutable_scene()->set_scene(CORNER_SPHERE);
    options_.mutable_shutter()->set_first_s(0.5);
  }
  ~RenderRecordingTest() override { fs::remove_all(dir_); }

  Status Render(const fs::path& path, int threads = 1) {
    ThreadPool pool(threads);
    return RenderRecording(options_, path, pool, {});
  }
  std::vector<RecordedItem> ReadAll(const fs::path& path) {
    auto reader = RecordingReader::Open(path);
    EXPECT_TRUE(reader);
    std::vector<RecordedItem> items;
    for (auto item = (*reader)->Next(); item && *item; item = (*reader)->Next()) {
      items.push_back(std::move(**item));
    }
    return items;
  }
  static std::string Bytes(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Result<fs::path> Cached(int* updates = nullptr) {
    ThreadPool pool(1);
    return CachedRecording(options_, dir_ / "cache", pool, [&](double) {
      if (updates != nullptr) ++*updates;
    });
  }

  fs::path dir_;
  SimulationOptions options_;
};

TEST_F(RenderRecordingTest, HoldsEveryFrameWithItsTimesAndTruth) {
  ASSERT_TRUE(Render(dir_ / "scan.mcap").ok());
  const auto scan = SimulatedScan::Create(options_);
  ASSERT_TRUE(scan);
  std::size_t depth = 0, thermal = 0, poses = 0, events = 0;
  for (const RecordedItem& item : ReadAll(dir_ / "scan.mcap")) {
    if (const auto* frame = std::get_if<RecordedDepth>(&item)) {
      const SimulatedFrameTime& time = (*scan)->depth_times()[depth];
      EXPECT_EQ(frame->frame.header.frame_number, depth++);
      EXPECT_EQ(frame->frame.header.capture_time, time.exposure);
      EXPECT_EQ(frame->frame.header.device_ticks, time.device_ticks);
      EXPECT_EQ(frame->arrival, time.arrival);
    } else if (const auto* frame_t = std::get_if<RecordedThermal>(&item)) {
      const SimulatedFrameTime& time = (*scan)->thermal_times()[thermal];
      EXPECT_EQ(frame_t->frame.header.frame_number, thermal++);
      EXPECT_EQ(frame_t->frame.header.capture_time, time.exposure);
      EXPECT_EQ(frame_t->frame.header.device_ticks, time.device_ticks);
      EXPECT_EQ(frame_t->arrival, time.arrival);
    } else if (const auto* pose = std::get_if<RecordedPose>(&item)) {
      EXPECT_EQ(pose->stream, "groundtruth");
      EXPECT_EQ(pose->pose.time, (*scan)->depth_times()[poses++].exposure);
      EXPECT_TRUE(pose->pose.T_world_depth.isApprox((*scan)->PoseAt(pose->pose.time), 1e-9));
    } else {
      ++events;
    }
  }
  EXPECT_EQ(depth, 36U);
  EXPECT_EQ(thermal, 48U);
  EXPECT_EQ(poses, 36U);
  EXPECT_EQ(events, 1U);
}

/// The motion between two poses is the true one, but for scale and jitter, whatever the reference.
TEST_F(RenderRecordingTest, OdometrySeesTheTrueMotionWithItsErrors) {
  OdometryOptions& odometry = *options_.mutable_odometry();
  odometry.set_rate_hz(100.0);
  odometry.set_scale_error(0.5);
  ASSERT_TRUE(Render(dir_ / "scan.mcap").ok());
  const auto scan = SimulatedScan::Create(options_);
  ASSERT_TRUE(scan);
  std::vector<ExternalOdometry> poses;
  for (const RecordedItem& item : ReadAll(dir_ / "scan.mcap")) {
    if (const auto* pose = std::get_if<ExternalOdometry>(&item)) poses.push_back(*pose);
  }
  const std::vector<SimulatedFrameTime>& frames = (*scan)->depth_times();
  const double seconds = ToSeconds(frames.back().exposure - frames.front().exposure);
  EXPECT_NEAR(static_cast<double>(poses.size()), 100.0 * seconds, 1.5);
  const auto seen = [&](std::size_t i) {
    return MakeTransform(poses[i].translation_m, poses[i].rotation);
  };
  const std::size_t last = poses.size() - 1;
  const RigidTransform motion = seen(0).inverse() * seen(last);
  const RigidTransform truth =
      (*scan)->PoseAt(poses[0].time).inverse() * (*scan)->PoseAt(poses[last].time);
  ASSERT_GT(truth.translation().norm(), 0.02);
  // Five sigmas of both ends, and the lever of the first one's rotation.
  constexpr double kJitter = 5.0 * 1.5 * 0.0005;
  EXPECT_LT((motion.translation() - 1.5 * truth.translation()).norm(), kJitter);
  EXPECT_LT(RotationAngle(motion, truth), 0.003);
  EXPECT_GT(TranslationDistance(seen(0), (*scan)->PoseAt(poses[0].time)), 1.0)
      << "another reference frame";
}

TEST_F(RenderRecordingTest, ExplainsItself) {
  ASSERT_TRUE(Render(dir_ / "scan.mcap").ok());
  auto reader = RecordingReader::Open(dir_ / "scan.mcap");
  ASSERT_TRUE(reader);
  EXPECT_TRUE((*reader)->info().complete);
  const auto& simulation = (*reader)->info().metadata.at("simulation");
  EXPECT_EQ(simulation.at("scene"), "corner-sphere");
  EXPECT_EQ(simulation.at("seed"), "1");
  SimulationOptions restored;
  EXPECT_TRUE(ParseTextProto(simulation.at("options"), "metadata", restored).ok());
  EXPECT_EQ(restored.duration_s(), 1.2);
  const Result<Rig> rig = (*reader)->ReadRig();
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->depth->width, 80);
}

TEST_F(RenderRecordingTest, FramesAreFlaggedAndFrozenWhileTheShutterIsClosed) {
  ASSERT_TRUE(Render(dir_ / "scan.mcap").ok());
  std::optional<NucEvent> event;
  std::vector<EncodedThermalFrame> frames;
  for (RecordedItem& item : ReadAll(dir_ / "scan.mcap")) {
    if (auto* found = std::get_if<NucEvent>(&item)) event = *found;
    if (auto* frame = std::get_if<RecordedThermal>(&item)) frames.push_back(frame->frame);
  }
  ASSERT_TRUE(event);
  Image<std::uint16_t> last_open;
  int closed = 0;
  for (const EncodedThermalFrame& frame : frames) {
    const CaptureTime time = frame.header.capture_time;
    const bool inside = time >= event->start && time < event->end;
    EXPECT_EQ(frame.nuc_state == NucState::kInProgress, inside);
    EXPECT_EQ(frame.valid, !inside);
    EXPECT_EQ(frame.seconds_since_nuc.has_value(), time >= event->end);
    const auto rendering = Decode(frame.image);
    ASSERT_TRUE(rendering);
    if (inside) {
      ++closed;
      EXPECT_EQ(*rendering, last_open);
    } else {
      EXPECT_NE(*rendering, last_open);
      last_open = *rendering;
    }
  }
  EXPECT_EQ(closed, 15);  // 0.375 s at 40 Hz.
}

TEST_F(RenderRecordingTest, ACameraMayShowItsShutterInstead) {
  options_.mutable_shutter()->mutable_expert()->set_appearance(ShutterOptions::SHUTTER);
  const auto scan = SimulatedScan::Create(options_);
  ASSERT_TRUE(scan);
  SimulatedScan::Scratch scratch;
  const RawFrame frame = (*scan)->RenderThermal(25, scratch);
  EXPECT_TRUE(frame.shutter_closed);
  for (const std::uint16_t value : frame.pixels.pixels()) {
    ASSERT_NEAR(value / 100.0 - 273.15, 31.0, 0.3);
  }
  EXPECT_FALSE((*scan)->RenderThermal(10, scratch).shutter_closed);
}

TEST_F(RenderRecordingTest, DoesNotDependOnTheNumberOfThreads) {
  ASSERT_TRUE(Render(dir_ / "one.mcap", 1).ok());
  ASSERT_TRUE(Render(dir_ / "three.mcap", 3).ok());
  EXPECT_TRUE(Bytes(dir_ / "one.mcap") == Bytes(dir_ / "three.mcap"));
}

TEST_F(RenderRecordingTest, AnotherSeedIsAnotherScan) {
  ASSERT_TRUE(Render(dir_ / "a.mcap").ok());
  options_.set_seed(2);
  ASSERT_TRUE(Render(dir_ / "b.mcap").ok());
  EXPECT_FALSE(Bytes(dir_ / "a.mcap") == Bytes(dir_ / "b.mcap"));
}

TEST_F(RenderRecordingTest, ProgressRisesToOne) {
  ThreadPool pool(2);
  double last = 0.0;
  ASSERT_TRUE(RenderRecording(options_, dir_ / "scan.mcap", pool, [&](double fraction) {
                EXPECT_GT(fraction, last);
                last = fraction;
              }).ok());
  EXPECT_EQ(last, 1.0);
}

TEST_F(RenderRecordingTest, OptionsOutOfRangeAreNamed) {
  options_.mutable_depth()->mutable_expert()->set_edge_dropout(1.5);
  const Status status = Render(dir_ / "scan.mcap");
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("depth.expert.edge_dropout"), std::string::npos);
  options_.mutable_depth()->mutable_expert()->clear_edge_dropout();
  options_.set_rig_file("no/such/rig.textproto");
  EXPECT_NE(Render(dir_ / "scan.mcap").message().find("rig_file"), std::string::npos);
  EXPECT_FALSE(fs::exists(dir_ / "scan.mcap"));
}

TEST_F(RenderRecordingTest, TheSecondRequestIsAnsweredFromTheCache) {
  int updates = 0;
  const auto first = Cached(&updates);
  ASSERT_TRUE(first);
  EXPECT_GT(updates, 0);
  updates = 0;
  const auto second = Cached(&updates);
  ASSERT_TRUE(second);
  EXPECT_EQ(*first, *second);
  EXPECT_EQ(updates, 0);
}

TEST_F(RenderRecordingTest, ChangedOptionsAreRenderedAgain) {
  const auto first = Cached();
  ASSERT_TRUE(first);
  options_.mutable_thermal()->mutable_expert()->set_netd_kelvin(0.05);
  int updates = 0;
  const auto second = Cached(&updates);
  ASSERT_TRUE(second);
  EXPECT_NE(*first, *second);
  EXPECT_GT(updates, 0);
}

TEST_F(RenderRecordingTest, TheRigFilesContentCountsAndItsPathDoesNot) {
  const auto name = CacheFileName(options_);
  ASSERT_TRUE(name);
  fs::copy(dir_ / "rig.textproto", dir_ / "copy.textproto");
  options_.set_rig_file(dir_ / "copy.textproto");
  EXPECT_EQ(*CacheFileName(options_), *name);
  options_.clear_rig_file();
  EXPECT_NE(*CacheFileName(options_), *name);
}

TEST_F(RenderRecordingTest, WritingOutDefaultsDoesNotRenderAgain) {
  const auto name = CacheFileName(options_);
  const SimulationOptions resolved = Resolved(options_);
  options_ = resolved;
  options_.set_seed(1);
  EXPECT_EQ(*CacheFileName(options_), *name);
}

TEST_F(RenderRecordingTest, AnIncompleteFileIsNotTaken) {
  const auto path = Cached();
  ASSERT_TRUE(path);
  const std::string complete = Bytes(*path);
  fs::resize_file(*path, complete.size() / 2);
  int updates = 0;
  ASSERT_TRUE(Cached(&updates));
  EXPECT_GT(updates, 0);
  EXPECT_TRUE(Bytes(*path) == complete);
}

TEST_F(RenderRecordingTest, AnInterruptedRunLeavesNothingThatLooksLikeAScan) {
  ThreadPool pool(1);
  std::stop_source stop;
  const auto interrupted = CachedRecording(
      options_, dir_ / "cache", pool, [&](double) { stop.request_stop(); }, stop.get_token());
  ASSERT_FALSE(interrupted);
  EXPECT_EQ(interrupted.error().code(), StatusCode::kUnavailable);
  EXPECT_TRUE(fs::is_empty(dir_ / "cache"));
}

TEST_F(RenderRecordingTest, LeftoversOfKilledRunsAreRemovedAndRunningOnesAreNot) {
  fs::create_directories(dir_ / "cache");
  const fs::path old = dir_ / "cache" / ".scan.mcap.1.unfinished";
  const fs::path young = dir_ / "cache" / ".scan.mcap.2.unfinished";
  std::ofstream(old) << "half a scan";
  std::ofstream(young) << "half a scan";
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(1));
  ASSERT_TRUE(Cached());
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(young));
}

TEST_F(RenderRecordingTest, ACacheFolderThatCannotBeMadeIsAClearError) {
  std::ofstream(dir_ / "file") << "not a folder";
  ThreadPool pool(1);
  const auto result = CachedRecording(options_, dir_ / "file" / "cache", pool, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code(), StatusCode::kIoError);
  EXPECT_NE(result.error().message().find("cache folder"), std::string::npos);
}

}  // namespace
}  // namespace isotherm
