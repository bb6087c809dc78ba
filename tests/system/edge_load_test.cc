// The edge under the load of a real rig: 640x480 depth at 30 Hz through OpenNI2 in its own process,
// 382x288 thermal at 40 Hz, recorded to disk and published over DDS to another process. Checks that
// every frame that the cameras made is accounted for, that none is lost unless others took the
// processors, and that memory stays bounded; prints CPU, memory and stamping latency.
// ISOTHERM_LOAD_SECONDS says how long (60).

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/pause.h"
#include "common/base/service.h"
#include "common/testing/temporary_directory.h"
#include "common/transport/participant.h"
#include "edge/camera_process/camera_process.h"
#include "edge/daemon/count_losses.h"
#include "edge/daemon/host_status.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/openni/testing/shared_counter.h"
#include "edge/options/edge_options.pb.h"
#include "edge/pipeline/edge_pipeline.h"
#include "edge/source/camera_pair.h"
#include "edge/spool/recording_files.h"
#include "tests/support/machine_load.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

constexpr int kThermalWidth = 382;
constexpr int kThermalHeight = 288;
constexpr std::chrono::milliseconds kThermalPeriod{25};
constexpr int kPreparedFrames = 8;
constexpr std::chrono::microseconds kDepthPeriod{33'333};
/// Frames that may be on their way when the recording begins or ends: those of the slots between
/// the camera's process and the edge, of the queue behind them and of the library.
constexpr std::uint64_t kMaxUnderWay = 32;
/// The edge may need this fraction of a core where it has the processors for itself.
constexpr double kMaxCpuFraction = 0.35;
/// From a frame's arrival to its stamp, seconds, in the middle.
constexpr double kSoonestStamp_s = 0.005;
/// The edge may hold this much memory, with its camera's process.
constexpr double kMaxMemory_mb = 60.0;
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

/// Returns what a process has in memory, MB; pages that processes share count for each with its
/// fraction.
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
    next_ += kThermalPeriod;
    RawFrame frame;
    frame.sensor = Sensor::kThermal;
    frame.arrival_steady = clock_.SteadyNow();
    frame.arrival_wall = clock_.Now();
    frame.frame_number = number_;
    frame.device_ticks = DeviceTicks(std::chrono::microseconds(kThermalPeriod) *
                                     static_cast<std::int64_t>(number_.load()));
    frame.pixels = frames_[number_ % frames_.size()];
    ++number_;
    return frame;
  }
  void Close() override {}
  /// How many frames there were. Thread-safe.
  std::uint64_t made() const { return number_; }

 private:
  const Clock& clock_;
  std::vector<Image<std::uint16_t>> frames_;
  SteadyTime next_{};
  std::atomic<std::uint64_t> number_{0};
};

class EdgeLoadTest : public ::testing::Test {
 protected:
  EdgeLoadTest() {
    setenv("LD_LIBRARY_PATH", FAKE_OPENNI, 1);
    camera_.script.pixels = folder_.path() / "depth.raw";
    camera_.script.counter = folder_.path() / "made";
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
    settings.arguments = {"--camera-process", "depth", "--camera-options",
                          "kind: CAMERAS camera_sandbox { expert { write: \"" +
                              folder_.path().string() + "\" read: \"" + camera_.folder().string() +
                              "\" } }"};
    auto depth = std::make_unique<CameraProcess>(settings, clock_);
    depth_ = depth.get();
    std::vector<CameraPair::Camera> cameras;
    cameras.push_back({Sensor::kDepth, Supervise(std::move(depth))});
    auto thermal = std::make_unique<PreparedThermalCamera>(clock_);
    thermal_ = thermal.get();
    cameras.push_back({Sensor::kThermal, Supervise(std::move(thermal))});
    const auto dropped = [this](Sensor sensor) {
      counters_.Count(sensor, FrameFate::kRecordQueueFull);
      counters_.Count(sensor, FrameFate::kPublishQueueFull);
    };
    return std::make_unique<CameraPair>(
        std::move(cameras),
        CameraPair::Queue{
            static_cast<std::size_t>(options_.source().expert().capture_queue_frames()),
            OverflowPolicy::kDropOldest, dropped});
  }
  std::unique_ptr<SupervisedSource> Supervise(std::unique_ptr<FrameSource> source) {
    auto supervised = std::make_unique<SupervisedSource>(
        std::move(source), options_.frame_check(), clock_,
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kCaptured); },
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kRejected); });
    CountLosses(*supervised, counters_);
    return supervised;
  }

  /// Holds what the edge needs, without the making of thermal frames.
  struct Usage {
    double cpu_fraction = 0.0;  ///< Part of a core.
    double memory_mb = 0.0;
    double child_memory_mb = 0.0;  ///< Memory of the depth camera's process.
  };

  void StartPublishing() {
    auto participant = Participant::Create(environment_, OwnDomain());
    ASSERT_TRUE(participant.has_value());
    participant_ = std::move(*participant);
    PublisherOptions publishing;
    publishing.policy = PublishPolicy::kLossless;
    auto publisher = Publisher::Create(*participant_, clock_, publishing);
    ASSERT_TRUE(publisher.has_value());
    publisher_ = std::move(*publisher);
    RigDescription rig;
    rig.session = kSession;
    ASSERT_TRUE(publisher_->BeginSession(rig, {}).ok());
  }

  /// Frames that the cameras have made, whoever took them.
  struct Made {
    std::uint64_t depth = 0;
    std::uint64_t thermal = 0;
    Made operator-(const Made& before) const {
      return {depth - before.depth, thermal - before.thermal};
    }
  };
  Made MadeSoFar() const {
    return {SharedCounter(camera_.script.counter).value(), thermal_->made()};
  }

  /// Captures, records and publishes for as long as the test lasts.
  void Run(CameraPair& cameras, Usage& usage) {
    const auto files = std::make_shared<RecordingFiles>(RecordingDescription{
        file_, FromSeconds(options_.spool().expert().flush_interval_s()), cameras.rig(), {}});
    auto spool = std::make_unique<Spool>(SpoolParts{[files] { return files->Next(); },
                                                    [this] { return FreeDiskBytes(file_); },
                                                    options_.spool(), clock_, counters_});
    ASSERT_TRUE(spool->Begin().ok());
    EdgePipeline pipeline(
        options_, {cameras, *publisher_, counters_, health_, clock_, std::move(spool), kSession});
    pipeline.StartReceiving();
    ASSERT_TRUE(publisher_->WaitForGround(std::chrono::seconds(20), {}));
    const double cpu_before_s = CpuSeconds(RUSAGE_SELF);
    const SteadyTime start = clock_.SteadyNow();
    const Made before = MadeSoFar();
    pipeline.StartCapture();
    Pause({}, FromSeconds(seconds_));
    made_ = MadeSoFar() - before;
    usage.memory_mb = Memory_mb("self");
    usage.child_memory_mb = Memory_mb(std::to_string(depth_->pid()));
    wall_s_ = ToSeconds(clock_.SteadyNow() - start);
    usage.cpu_fraction = (CpuSeconds(RUSAGE_SELF) - cpu_before_s) / wall_s_;
    EXPECT_TRUE(pipeline.Stop().ok());
    // As the daemon says it: only now the ground knows that no earlier number is still to come.
    EdgeStatus ended;
    ended.time = clock_.Now();
    ended.scan_state = ScanState::kEnded;
    EXPECT_TRUE(publisher_->Publish(ended).ok());
    EXPECT_TRUE(publisher_->Drain(std::chrono::seconds(20)));
  }

  /// Prints the figures; whatever was lost must have been counted.
  void ReportAndCheckCounters(const Usage& usage) {
    std::printf(
        "edge: %.1f %% of a core, %.0f MB resident; depth camera's process: %.1f %%, %.0f MB\n",
        100.0 * usage.cpu_fraction, usage.memory_mb, 100.0 * CpuSeconds(RUSAGE_CHILDREN) / wall_s_,
        usage.child_memory_mb);
    const auto recording = RecordingReader::Open(file_);
    ASSERT_TRUE(recording.has_value());
    EXPECT_TRUE((*recording)->info().complete);
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      const bool is_depth = sensor == Sensor::kDepth;
      const SensorCounters counters = counters_.Get(sensor);
      const CameraReport report = health_.Get(sensor);
      std::printf(
          "%s: due %lu; captured %lu, lost in the camera or its library %lu; left out in the "
          "camera's process %lu, recorded %lu, published %lu; stamped p50 %.3f ms p99 %.3f ms "
          "after arrival\n",
          is_depth ? "depth" : "thermal", Due(sensor), counters.captured, counters.lost_in_camera,
          counters.left_out, counters.recorded, counters.published, report.stamping_p50_s * 1e3,
          report.stamping_p99_s * 1e3);
      EXPECT_GT(counters.captured, 0U);
      EXPECT_EQ(counters.OnTheWayToDisk(), 0);
      EXPECT_EQ(counters.OnTheWayToGround(), 0);
      EXPECT_EQ(counters.recorded,
                (*recording)->info().messages_by_topic.at(is_depth ? "/depth" : "/thermal"));
    }
  }

  /// How many frames the camera had to make from the first to the last one that was recorded, by
  /// the camera's own clock.
  std::uint64_t Due(Sensor sensor) const {
    const auto recording = RecordingReader::Open(file_);
    if (!recording) return 0;
    std::vector<DeviceTicks> ticks;
    while (true) {
      const Result<std::optional<RecordedItem>> item = (*recording)->Next();
      if (!item || !*item) break;
      const auto* depth = std::get_if<RecordedDepth>(&**item);
      const auto* thermal = std::get_if<RecordedThermal>(&**item);
      if (depth != nullptr && sensor == Sensor::kDepth)
        ticks.push_back(depth->frame.header.device_ticks);
      if (thermal != nullptr && sensor == Sensor::kThermal)
        ticks.push_back(thermal->frame.header.device_ticks);
    }
    if (ticks.empty()) return 0;
    const Nanoseconds period =
        sensor == Sensor::kDepth ? Nanoseconds(kDepthPeriod) : kThermalPeriod;
    const double periods = ToSeconds(ticks.back() - ticks.front()) / ToSeconds(period);
    return static_cast<std::uint64_t>(std::lround(periods)) + 1;
  }

  /// Whatever the computer did meanwhile: each frame that was due is captured, or counted as lost.
  /// The number due is known from outside: by the time that capturing took, by what the cameras
  /// made in it, and by their clocks between the first and the last recorded frame.
  void ExpectEachFrameIsAccountedFor() {
    for (const auto& [sensor, made, period] :
         {std::tuple(Sensor::kDepth, made_.depth, kDepthPeriod),
          std::tuple(Sensor::kThermal, made_.thermal, std::chrono::microseconds(kThermalPeriod))}) {
      const SensorCounters counters = counters_.Get(sensor);
      const std::uint64_t accounted = counters.captured + counters.lost_in_camera;
      const auto due_by_the_clock = static_cast<std::uint64_t>(wall_s_ / ToSeconds(period));
      EXPECT_GE(made + kMaxUnderWay, due_by_the_clock) << "the camera stood still";
      EXPECT_GE(accounted + kMaxUnderWay, made) << "capture began late or ended early";
      EXPECT_LE(accounted, made + kMaxUnderWay) << "more than the camera has made";
      const std::uint64_t due = Due(sensor);
      EXPECT_GE(accounted, due) << "frames vanished";
      EXPECT_LE(accounted, due + kMaxUnderWay) << "frames were counted twice";
    }
  }

  /// No larger a part may be lost than others took of the processors: nothing where they
  /// took little, a quarter at most.
  void ExpectNoMoreIsLostThanOthersTook(const MachineLoad& load) {
    const double fraction = load.excused_fraction();
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      const SensorCounters counters = counters_.Get(sensor);
      const std::uint64_t due = counters.captured + counters.lost_in_camera;
      const double most = fraction * static_cast<double>(due);
      EXPECT_LE(static_cast<double>(due - counters.recorded), most) << load.ToText();
      EXPECT_LE(static_cast<double>(due - counters.published), most) << load.ToText();
    }
  }

  /// `received`: what the other process says at its end. It has all that was published, or lacks no
  /// larger a part than others took of the processors.
  void ExpectReceived(const std::string& received, const MachineLoad& load) {
    const double fraction = load.excused_fraction();
    unsigned long depth = 0, thermal = 0;
    const std::size_t at = received.find("received depth=");
    ASSERT_NE(at, std::string::npos) << received;
    ASSERT_EQ(
        std::sscanf(received.c_str() + at, "received depth=%lu thermal=%lu", &depth, &thermal), 2);
    for (const auto& [sensor, frames] :
         {std::pair(Sensor::kDepth, depth), std::pair(Sensor::kThermal, thermal)}) {
      const auto published = static_cast<double>(counters_.Get(sensor).published);
      EXPECT_LE(static_cast<double>(frames), published);
      EXPECT_GE(static_cast<double>(frames), (1.0 - fraction) * published) << load.ToText();
    }
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "scan.mcap";
  FakeDepthCamera camera_;
  double seconds_ = 60.0;
  EdgeOptions options_;
  const SystemClock clock_{};
  const TransportEnvironment environment_{clock_};
  std::unique_ptr<Participant> participant_;
  std::unique_ptr<Publisher> publisher_;
  double wall_s_ = 0.0;  ///< Time that it ran.
  Made made_;            ///< Frames that the cameras made in that time.
  FrameCounters counters_;
  CameraHealth health_;
  CameraProcess* depth_ = nullptr;
  PreparedThermalCamera* thermal_ = nullptr;
};

TEST_F(EdgeLoadTest, EachFrameIsAccountedForAndMemoryIsBounded) {
  UseSmallPages();  // As isotherm-edge does.
  ShareFreedMemory();
  Process sink({FRAME_SINK, {std::to_string(OwnDomain())}, {}, {}});
  ASSERT_TRUE(sink.WaitForOutput("listening", kPatience));
  ASSERT_NO_FATAL_FAILURE(StartPublishing());
  const std::unique_ptr<CameraPair> cameras = MakeCameras();
  const Status opened = cameras->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  Usage usage;
  const MachineLoad load;
  ASSERT_NO_FATAL_FAILURE(Run(*cameras, usage));
  std::printf("%s\n", load.ToText().c_str());
  ASSERT_NO_FATAL_FAILURE(ReportAndCheckCounters(usage));
  ExpectEachFrameIsAccountedFor();
  ExpectNoMoreIsLostThanOthersTook(load);
  EXPECT_LT(usage.memory_mb + usage.child_memory_mb, kMaxMemory_mb);
  sink.Signal(SIGTERM);
  EXPECT_EQ(sink.WaitForExit(kPatience), 0);
  ExpectReceived(sink.output(), load);
  if (load.is_busy()) {
    GTEST_SKIP() << load.ToText() << ": all was assessed but times and the fraction of a processor";
  }
  EXPECT_LT(usage.cpu_fraction, kMaxCpuFraction);
  EXPECT_LT(health_.Get(Sensor::kDepth).stamping_p50_s, kSoonestStamp_s);
  EXPECT_LT(health_.Get(Sensor::kThermal).stamping_p50_s, kSoonestStamp_s);
}

}  // namespace
}  // namespace isotherm::system_test
