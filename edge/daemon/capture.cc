#include "edge/daemon/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/processor_time.h"
#include "common/base/service.h"
#include "edge/daemon/edge_monitor.h"
#include "edge/daemon/edge_report.h"
#include "edge/daemon/rig_announcer.h"
#include "edge/daemon/scan_orders.h"
#include "edge/daemon/stop_limits.h"
#include "edge/options/edge_options.pb.h"
#include "edge/pipeline/edge_pipeline.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

void WaitForGround(Publisher& publisher, const std::stop_token& stop) {
  LOG(Edge, Info) << "waiting for a ground station";
  while (!stop.stop_requested() && !publisher.WaitForGround(milliseconds(500), stop)) {
    NotifyWatchdog();
  }
}

/// Lets the ground confirm what was sent. False if it did not in time.
bool Drain(Publisher& publisher, const LinkOptions& options, const Clock& clock,
           const std::stop_token& stop) {
  const SteadyTime start = clock.SteadyNow();
  while (!publisher.Drain(stop_limits::kTick)) {
    const Nanoseconds configured = FromSeconds(options.expert().linger_s());
    const Nanoseconds limit =
        stop.stop_requested() ? std::min(configured, stop_limits::kLingerAfterSignal) : configured;
    if (clock.SteadyNow() - start >= limit) return false;
  }
  return true;
}

/// Holds what had been used when a capture began.
struct CaptureBegin {
  SteadyTime time;
  ProcessorTimes processor;
  double cameras_s = 0.0;  ///< By processes of cameras of scans before.
};

/// Returns what the capture has cost, to be asked for while its threads still live.
std::string ProcessorText(const CaptureBegin& begin, SteadyTime now) {
  return "processor " + ToText(ReadProcessorTimes() - begin.processor, ToSeconds(now - begin.time));
}

/// Completes that, once the processes of cameras have ended.
void PrintProcessorText(const std::string& text, const CaptureBegin& begin) {
  const double cameras_s = ProcessorTimeOfChildren_s() - begin.cameras_s;
  std::fputs(text.c_str(), stdout);
  std::fputs(
      cameras_s > 0.0 ? fmt::format("; processes of cameras {:.1f} s\n", cameras_s).c_str() : "\n",
      stdout);
  std::fflush(stdout);
}

void PrintSummary(const CaptureParts& parts, const EdgePipeline& pipeline, bool recording) {
  std::fputs(
      Summary(parts.counters, recording, parts.publisher.receipt(), pipeline.feedback().latency())
          .c_str(),
      stdout);
  if (const std::uint64_t frames = pipeline.frames_backfilled(); frames > 0) {
    std::fputs(
        fmt::format("backfill {} frames reached the ground from the recording\n", frames).c_str(),
        stdout);
  }
  if (const std::uint64_t frames = pipeline.frames_gone(); frames > 0) {
    std::fputs(fmt::format("deleted  {} frames that the ground does not have, to keep the newest "
                           "(spool.when_full=KEEP_NEWEST)\n",
                           frames)
                   .c_str(),
               stdout);
  }
  std::fputs(
      CameraSummary(parts.health.Get(Sensor::kDepth), parts.health.Get(Sensor::kThermal)).c_str(),
      stdout);
  std::fflush(stdout);
}

/// Runs one scan: its line of threads, what looks after it, and the ground's orders to stop it and
/// to start the next one. Thread-bound to the main thread.
class Scan {
 public:
  Scan(const CaptureParts& parts, std::unique_ptr<Spool> spool)
      : parts_(parts),
        is_recorded_(spool != nullptr),
        pipeline_(parts.options, {parts.source, parts.publisher, parts.counters, parts.health,
                                  parts.clock, std::move(spool), parts.session.session(),
                                  parts.session.first_numbers, parts.session.rig_thermal_delay_s}) {
  }

  CaptureEnd Run();

 private:
  enum class Next { kLeave, kAnotherScan };

  Next RunUntilTold(EdgeMonitor& monitor, RigAnnouncer& announcer);
  /// Stops a scan that is not to go on without a recording.
  void StopIfFull();
  /// Ends the cameras of a scan that was ordered to stop; what they have sent is still under way.
  /// Returns false if one does not end.
  bool EndCameras();
  /// Returns whether there is a ground that may take what it lacks.
  bool IsHeard() const {
    constexpr Nanoseconds kSilent = std::chrono::seconds(5);
    const std::optional<Nanoseconds> age = parts_.publisher.stats().receipt_age;
    return age && *age < kSilent;
  }
  /// Closes the recording of a scan of which nothing is captured any more.
  void CloseRecording();
  /// Ends the recording, then the link, each in its time; `say` tells what was done. The process's
  /// exit status.
  int Leave(EdgeMonitor& monitor, const std::function<void()>& say);

  const CaptureParts& parts_;
  const bool is_recorded_;
  const CaptureBegin begin_{parts_.clock.SteadyNow(), ReadProcessorTimes(),
                            ProcessorTimeOfChildren_s()};
  EdgePipeline pipeline_;
  ScanOrders orders_;
  std::string cost_;  ///< ProcessorText, once the scan is over.
};

CaptureEnd Scan::Run() {
  const auto& [options, session, source, counters, health, publisher, leaving, is_scanning, on_idle,
               clock, stop] = parts_;
  pipeline_.StartReceiving();
  NotifyReady(fmt::format("capturing from {}", source.name()));
  LOG(Edge, Info) << "started: " << source.name() << ", edge_id=" << options.link().edge_id()
                  << " domain=" << options.link().domain() << " session=" << session.session();
  if (options.link().wait_for_ground()) WaitForGround(publisher, stop);

  is_scanning = true;
  pipeline_.StartCapture();
  EdgeMonitor monitor({clock, pipeline_, publisher, counters, health},
                      options.display().image_file());
  RigAnnouncer announcer(options, session, health, publisher,
                         [this](RigUpdate update) { pipeline_.RecordRig(std::move(update)); });
  const Next next = RunUntilTold(monitor, announcer);
  if (cost_.empty()) cost_ = ProcessorText(begin_, clock.SteadyNow());
  const auto say = [this] {
    PrintSummary(parts_, pipeline_, is_recorded_);
    PrintProcessorText(cost_, begin_);
  };
  if (next == Next::kLeave) {
    NotifyStopping();
    return {.status = Leave(monitor, say), .another_scan = false};
  }
  const int status = pipeline_.Stop().ok() ? 0 : kExitRecording;
  monitor.PublishEnd();
  say();
  return {.status = status, .another_scan = true};
}

Scan::Next Scan::RunUntilTold(EdgeMonitor& monitor, RigAnnouncer& announcer) {
  while (!parts_.stop.stop_requested()) {
    monitor.Tick();
    announcer.Tick();
    for (const Command& order : pipeline_.TakeScanOrders()) {
      pipeline_.Answer(orders_.Execute(order));
    }
    StopIfFull();
    if (orders_.state() == ScanOrders::State::kStarting) return Next::kAnotherScan;
    const bool ordered = orders_.state() == ScanOrders::State::kEnding;
    // The service manager starts the program anew.
    if (ordered && !EndCameras()) return Next::kLeave;
    // Before the ground has everything: whoever switches the rig off then has a whole recording.
    // Leaving closes it, too, and in time.
    if (!parts_.options.exit_at_end() && cost_.empty() && pipeline_.IsCaptured()) CloseRecording();
    if (pipeline_.IsCaptured()) parts_.is_scanning = !pipeline_.finished() && IsHeard();
    if (pipeline_.finished()) {
      if (parts_.options.exit_at_end()) return Next::kLeave;
      if (orders_.NoteFinished()) {
        LOG(Edge, Info)
            << (ordered ? "the scan has ended as ordered" : "the source has ended")
            << "; waiting for the order to start another scan, or for a signal to leave";
        parts_.on_idle();
      }
    }
    Pause(parts_.stop, stop_limits::kTick);
  }
  return Next::kLeave;
}

void Scan::StopIfFull() {
  if (parts_.options.spool().when_full() != STOP_SCAN) return;
  const std::optional<SpoolStatus> recording = pipeline_.recording();
  if (!recording || !recording->is_full || orders_.state() != ScanOrders::State::kScanning) return;
  static_cast<void>(orders_.Execute({.kind = CommandKind::kStopScan}));
}

bool Scan::EndCameras() {
  if (pipeline_.StopCapture(stop_limits::kCameras)) return true;
  LOG(Edge, Error) << "the scan was ordered to stop, and a camera does not end";
  return false;
}

void Scan::CloseRecording() {
  cost_ = ProcessorText(begin_, parts_.clock.SteadyNow());
  const Status closed = pipeline_.StopRecording();
  if (!closed.ok()) {
    LOG(Edge, Error) << "the recording is not complete: " << closed.message();
  } else if (is_recorded_) {
    LOG(Edge, Info) << "the recording is closed";
  }
}

int Scan::Leave(EdgeMonitor& monitor, const std::function<void()>& say) {
  ExitDeadline& deadline = parts_.leaving.deadline;
  const LinkOptions& link = parts_.options.link();
  // With a signal the time already runs.
  deadline.ArmFirst(stop_limits::kCameras + stop_limits::kDisk, kExitRecording, "a camera", say);
  const bool cameras_ended = pipeline_.StopCapture(stop_limits::kCameras);
  if (!cameras_ended) {
    LOG(Edge, Error) << "a camera did not end within " << ToSeconds(stop_limits::kCameras)
                     << " s; leaving without it";
  }
  deadline.Arm(stop_limits::kDisk, kExitRecording, "the disk", say);
  const int status = pipeline_.StopRecording().ok() ? 0 : kExitRecording;
  const Nanoseconds linger =
      parts_.stop.stop_requested() ? Nanoseconds(0) : FromSeconds(link.expert().linger_s());
  deadline.Arm(stop_limits::kLink + linger, status, "the network", say);
  static_cast<void>(pipeline_.Stop());
  monitor.PublishEnd();
  if (!Drain(parts_.publisher, link, parts_.clock, parts_.stop)) {
    LOG(Edge, Warning) << "the ground did not confirm all frames before the end";
  }
  deadline.Arm(stop_limits::kMiddleware, status,
               cameras_ended ? "the middleware or standard output" : "a camera");
  say();
  return status;
}

}  // namespace

CaptureEnd Capture(const CaptureParts& parts, std::unique_ptr<Spool> spool) {
  if (spool) parts.leaving.status_if_stuck = kExitRecording;
  return Scan(parts, std::move(spool)).Run();
}

}  // namespace isotherm
