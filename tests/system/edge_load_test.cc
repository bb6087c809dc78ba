// The edge under the load of a real rig: 640x480 depth at 30 Hz through OpenNI2 in its own process,
// 382x288 thermal at 40 Hz, recorded to disk and published over DDS to another process. Checks that
// nothing is lost and memory stays bounded; prints CPU, memory and stamping latency.
// ISOTHERM_LOAD_SECONDS says how long (60).

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <thread>

#include "common/testing/temporary_directory.h"
#include "common/transport/participant.h"
#include "edge/edge_options.pb.h"
#include "edge/edge_pipeline.h"
#include "edge/openni/fake_depth_camera.h"
#include "edge/source/camera_pair.h"
#include "edge/source/camera_process.h"
#include "edge/source/pause.h"
#include "tests/system/programs.h"

namespace isotherm::system_test {
namespace {

constexpr int kThermalWidth = 382;
constexpr int kThermalHeight = 288;
constexpr std::chrono::milliseconds kThermalPeriod{25};
constexpr int kPreparedFrames = 8;
/// A computer that leaves a thread waiting for longer does something else: nothing is learnt then.
constexpr std::chrono::milliseconds kStarved{50};
/// What the edge may hold in memory, with its camera's process.
constexpr double kMostMemory_mb = 150.0;
constexpr unsigned kSeed = 20;
constexpr std::uint64_t kSession = 1;

double CpuSeconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// What a process has in memory, MB; pages that processes share count for each with its share.
double Memory_mb(const std::string& process) {
  std::ifstream pages("/proc/" + process + "/smaps_rollup");
  for (std::string line; std::getline(pages, line);) {
    if (line.starts_with("Pss:")) return std::atof(line.c_str() + 4) / 1024.0;
  }
  return 0.0;
}

/// A thermal camera whose frames are prepared once: noise of a real camera (0.05 K) on a warm blob.
class PreparedThermalCamera final : public FrameSource {
 public:
  explicit PreparedThermalCamera(const Clock& clock) : clock_(clock) {
    std::mt19937 random(kSeed);
    std::normal_distribution<double> noise(0.0, 5.0);
    for (int i = 0; i < kPreparedFrames; ++i) {
      Image<std::uint16_t> image(kThermalWidth, kThermalHeight);
      for (int v = 0; v < kThermalHeight; ++v) {
        for (int u = 0; u < kThermalWidth; ++u) {
          const double blob =
              4000.0 / (1.0 + 0.001 * ((u - 190) * (u - 190) + (v - 144) * (v - 144)));
          image.At(u, v) = static_cast<std::uint16_t>(29'500.0 + blob + noise(random));
        }
      }
      frames_.push_back(std::move(image));
    }
  }
  std::string_view name() const override { return "prepared thermal camera"; }
  Status Open() override {
    next_ = clock_.SteadyNow();
    return OkStatus();
  }
  Result<SourceItem> Read(std::stop_token stop) override {
    Pause(stop, next_ - clock_.SteadyNow());
    if (stop.stop_requested()) return NothingYet{};
    latest_ = std::max(latest_.load(), clock_.SteadyNow() - next_);
    next_ += kThermalPeriod;
    RawFrame frame;
    frame.sensor = Sensor::kThermal;
    frame.arrival_steady = clock_.SteadyNow();
    frame.arrival_wall = clock_.Now();
    frame.frame_number = number_;
    frame.device_ticks =
        DeviceTicks(std::chrono::microseconds(kThermalPeriod) * static_cast<int>(number_));
    frame.pixels = frames_[number_ % frames_.size()];
    ++number_;
    return frame;
  }
  void Close() override {}
  /// How late a frame was at most: how long this computer left a thread waiting that could run.
  Nanoseconds latest() const { return latest_; }

 private:
  const Clock& clock_;
  std::atomic<Nanoseconds> latest_{Nanoseconds(0)};
  std::vector<Image<std::uint16_t>> frames_;
  SteadyTime next_{};
  std::uint64_t number_ = 0;
};

class EdgeLoadTest : public ::testing::Test {
 protected:
  EdgeLoadTest() {
    setenv("LD_LIBRARY_PATH", FAKE_OPENNI, 1);
    camera_.script.pixels = folder_.path() / "depth.raw";
    WriteDepth(camera_.script.pixels);
    camera_.Apply();
    if (const char* text = std::getenv("ISOTHERM_LOAD_SECONDS")) seconds_ = std::atof(text);
  }

  /// A tilted plane with a step, noise of 1 mm and holes at the step.
  static void WriteDepth(const std::filesystem::path& path) {
    std::mt19937 random(kSeed);
    std::normal_distribution<double> noise(0.0, 1.0);
    std::ofstream file(path, std::ios::binary);
    for (int i = 0; i < kPreparedFrames; ++i) {
      std::vector<std::uint16_t> frame;
      for (int v = 0; v < 480; ++v) {
        for (int u = 0; u < 640; ++u) {
          const double plane = 600.0 + 0.3 * u + 0.1 * v + (u > 320 ? 80.0 : 0.0);
          const bool hole = std::abs(u - 320) < 8;
          frame.push_back(hole ? 0 : static_cast<std::uint16_t>(plane + noise(random)));
        }
      }
      file.write(reinterpret_cast<const char*>(frame.data()),
                 static_cast<std::streamsize>(frame.size() * 2));
    }
  }

  std::unique_ptr<CameraPair> MakeCameras() {
    CameraProcess::Settings settings;
    settings.name = "depth camera";
    settings.program = EdgeDaemon();
    settings.arguments = {"--camera-process", "depth", "--camera-options", "kind: CAMERAS"};
    auto depth = std::make_unique<CameraProcess>(settings, clock_);
    depth_ = depth.get();
    std::vector<CameraPair::Camera> cameras;
    cameras.push_back({Sensor::kDepth, Supervise(std::move(depth))});
    auto thermal = std::make_unique<PreparedThermalCamera>(clock_);
    thermal_ = thermal.get();
    cameras.push_back({Sensor::kThermal, Supervise(std::move(thermal))});
    const auto dropped = [this](Sensor sensor) {
      account_.Count(sensor, FrameFate::kRecordQueueFull);
      account_.Count(sensor, FrameFate::kPublishQueueFull);
    };
    return std::make_unique<CameraPair>(
        std::move(cameras),
        CameraPair::Queue{static_cast<std::size_t>(options_.capture_queue_frames()),
                          OverflowPolicy::kDropOldest, dropped});
  }
  std::unique_ptr<SupervisedSource> Supervise(std::unique_ptr<FrameSource> source) {
    return std::make_unique<SupervisedSource>(
        std::move(source), options_.frame_check(), clock_,
        [this](Sensor sensor) { account_.Count(sensor, FrameFate::kCaptured); },
        [this](Sensor sensor) { account_.Count(sensor, FrameFate::kRejected); });
  }

  /// What the edge needs, without the making of thermal frames.
  struct Usage {
    double cpu_share = 0.0;  ///< Of a core.
    double memory_mb = 0.0;
    double child_memory_mb = 0.0;  ///< Of the depth camera's process.
  };

  void StartPublishing() {
    auto participant = Participant::Create(environment_, TestDomain());
    ASSERT_TRUE(participant.has_value());
    participant_ = std::move(*participant);
    PublisherOptions publishing;
    publishing.policy = PublishPolicy::kLossless;
    auto publisher = Publisher::Create(*participant_, clock_, publishing);
    ASSERT_TRUE(publisher.has_value());
    publisher_ = std::move(*publisher);
    RigDescription rig;
    rig.session = kSession;
    ASSERT_TRUE(publisher_->BeginSession(rig).ok());
  }

  /// Captures, records and publishes for as long as the test lasts.
  void Run(CameraPair& cameras, Usage& usage) {
    auto spool = Spool::Create(file_, options_.spool(), cameras.rig(), {}, account_);
    ASSERT_TRUE(spool.has_value());
    EdgePipeline pipeline(
        options_, {cameras, *publisher_, account_, health_, clock_, std::move(*spool), kSession});
    pipeline.StartReceiving();
    ASSERT_TRUE(publisher_->WaitForGround(std::chrono::seconds(20), {}));
    const double cpu_before_s = CpuSeconds(RUSAGE_SELF);
    const SteadyTime start = clock_.SteadyNow();
    pipeline.StartCapture();
    Pause({}, FromSeconds(seconds_));
    usage.memory_mb = Memory_mb("self");
    usage.child_memory_mb = Memory_mb(std::to_string(depth_->pid()));
    wall_s_ = ToSeconds(clock_.SteadyNow() - start);
    usage.cpu_share = (CpuSeconds(RUSAGE_SELF) - cpu_before_s) / wall_s_;
    EXPECT_TRUE(pipeline.Stop().ok());
    // As the daemon says it: only now the ground knows that no earlier number is still to come.
    EdgeStatus ended;
    ended.time = clock_.Now();
    ended.scan_state = ScanState::kEnded;
    EXPECT_TRUE(publisher_->Publish(ended).ok());
    EXPECT_TRUE(publisher_->Drain(std::chrono::seconds(20)));
  }

  /// Prints the figures; whatever was lost must have been counted.
  void ReportAndCheckAccounts(const Usage& usage) {
    std::printf(
        "edge: %.1f %% of a core, %.0f MB resident; depth camera's process: %.1f %%, %.0f MB\n",
        100.0 * usage.cpu_share, usage.memory_mb, 100.0 * CpuSeconds(RUSAGE_CHILDREN) / wall_s_,
        usage.child_memory_mb);
    const auto recording = RecordingReader::Open(file_);
    ASSERT_TRUE(recording.has_value());
    EXPECT_TRUE((*recording)->info().complete);
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      const bool is_depth = sensor == Sensor::kDepth;
      const SensorAccount account = account_.Get(sensor);
      const CameraReport report = health_.Get(sensor);
      std::printf(
          "%s: captured %lu, recorded %lu, published %lu; stamped p50 %.3f ms p99 %.3f ms after "
          "arrival\n",
          is_depth ? "depth" : "thermal", account.captured, account.recorded, account.published,
          report.stamping_p50_s * 1e3, report.stamping_p99_s * 1e3);
      EXPECT_GT(account.captured, 0U);
      EXPECT_EQ(account.OnTheWayToDisk(), 0);
      EXPECT_EQ(account.OnTheWayToGround(), 0);
      EXPECT_EQ(account.recorded,
                (*recording)->info().messages_by_topic.at(is_depth ? "/depth" : "/thermal"));
    }
  }

  /// `received`: what the other process says at its end.
  void ExpectNothingIsLost(const std::string& received) {
    const SensorAccount depth = account_.Get(Sensor::kDepth);
    const SensorAccount thermal = account_.Get(Sensor::kThermal);
    for (const SensorAccount& account : {depth, thermal}) {
      EXPECT_EQ(account.recorded, account.captured);
      EXPECT_EQ(account.published, account.captured);
    }
    std::ostringstream expected;
    expected << "received depth=" << depth.captured << " thermal=" << thermal.captured;
    EXPECT_NE(received.find(expected.str()), std::string::npos) << received;
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "scan.mcap";
  FakeDepthCamera camera_{folder_.path()};
  double seconds_ = 60.0;
  EdgeOptions options_;
  const SystemClock clock_;
  const TransportEnvironment environment_{clock_};
  std::unique_ptr<Participant> participant_;
  std::unique_ptr<Publisher> publisher_;
  double wall_s_ = 0.0;  ///< That it ran.
  FrameAccount account_;
  CameraHealth health_;
  CameraProcess* depth_ = nullptr;
  PreparedThermalCamera* thermal_ = nullptr;
};

TEST_F(EdgeLoadTest, NoFrameIsLostAndMemoryIsBounded) {
  Process sink({FRAME_SINK, {std::to_string(TestDomain())}, {}, {}});
  ASSERT_TRUE(sink.WaitForOutput("listening", kPatience));
  ASSERT_NO_FATAL_FAILURE(StartPublishing());
  const std::unique_ptr<CameraPair> cameras = MakeCameras();
  const Status opened = cameras->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  Usage usage;
  ASSERT_NO_FATAL_FAILURE(Run(*cameras, usage));
  ASSERT_NO_FATAL_FAILURE(ReportAndCheckAccounts(usage));
  if (thermal_->latest() > kStarved) {
    GTEST_SKIP() << "this computer is busy: a thread that could run waited for "
                 << ToSeconds(thermal_->latest())
                 << " s; accounts close, but losses and memory say nothing";
  }
  EXPECT_LT(usage.memory_mb + usage.child_memory_mb, kMostMemory_mb);
  sink.Signal(SIGTERM);
  EXPECT_EQ(sink.WaitForExit(kPatience), 0);
  ExpectNothingIsLost(sink.output());
}

}  // namespace
}  // namespace isotherm::system_test
