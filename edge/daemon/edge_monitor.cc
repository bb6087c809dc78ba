#include "edge/daemon/edge_monitor.h"

#include <optional>
#include <utility>

#include "common/base/log.h"
#include "common/base/service.h"
#include "edge/daemon/replace_file.h"

namespace isotherm {
namespace {

/// The rate that the ground counts on: it takes an edge that is silent for two of these for gone
/// (RigGate::kSilence).
constexpr Nanoseconds kStatusInterval = std::chrono::seconds(1);
/// A line in the journal this often shows that all is well, and fills no disk.
constexpr Nanoseconds kLogInterval = std::chrono::seconds(10);
// A camera that works sends something within this time, or its source says that it is lost. Longer
// than any correction of a thermal camera and any stall limit of the sources; shorter, and the
// service manager restarts an edge whose camera is only slow.
constexpr Nanoseconds kNoFrames = std::chrono::seconds(10);

}  // namespace

MonitorHost ThisComputer() {
  return {.read = [] { return ReadHostStatus("."); },
          .notify_status = NotifyStatus,
          .notify_alive = NotifyWatchdog,
          .watchdog_interval = WatchdogInterval()};
}

EdgeMonitor::EdgeMonitor(const EdgeMonitorParts& parts, std::filesystem::path image_file,
                         MonitorHost host)
    : clock_(parts.clock),
      pipeline_(parts.pipeline),
      publisher_(parts.publisher),
      counters_(parts.counters),
      health_(parts.health),
      image_file_(std::move(image_file)),
      host_(std::move(host)),
      terminal_(line_->is_terminal()),
      synchronised_(host_.read().clock.synchronised),
      next_status_(clock_.SteadyNow()),
      next_log_(next_status_ + kLogInterval),
      next_feed_(next_status_),
      newest_depth_{.at = next_status_},
      newest_thermal_{.at = next_status_} {}

void EdgeMonitor::Tick() {
  pipeline_.AnswerCommands();
  const SteadyTime now = clock_.SteadyNow();
  // First: what follows may take its time on a slow terminal.
  FeedWatchdog(now);
  ShowFeedback();
  if (now < next_status_) return;
  // From the deadline and not from now, so that the rate holds.
  next_status_ += kStatusInterval;
  const bool ended = pipeline_.finished();
  const EdgeStatus before = std::exchange(status_, {});
  status_ = MakeStatus(ended ? ScanState::kEnded : ScanState::kScanning, now);
  LogCameras(before);
  LogClock();
  const Status published = publisher_.Publish(status_);
  if (!published.ok()) {
    LOG(Edge, Debug) << "status not published: " << published.message();
  }
  ShowLine();
  ReportStatus();
  Log();
}

void EdgeMonitor::PublishEnd() {
  const Status published = publisher_.Publish(MakeStatus(ScanState::kEnded, clock_.SteadyNow()));
  if (!published.ok()) {
    LOG(Edge, Warning) << "final status not published: " << published.message();
  }
  line_.reset();  // What follows is below it.
}

EdgeStatus EdgeMonitor::MakeStatus(ScanState scan_state, SteadyTime now) {
  const SensorCounters depth = counters_.Get(Sensor::kDepth);
  const SensorCounters thermal = counters_.Get(Sensor::kThermal);
  EdgeStatus status;
  status.time = clock_.Now();
  status.scan_state = scan_state;
  status.depth = ToStreamStatus(depth, depth_rate_.Update(depth.captured, now));
  status.thermal = ToStreamStatus(thermal, thermal_rate_.Update(thermal.captured, now));
  status.nuc = pipeline_.nuc();
  status.feedback = pipeline_.feedback().latency();
  status.spool_fill_ratio = pipeline_.spool_fill_ratio();
  status.depth_camera = health_.Get(Sensor::kDepth);
  status.thermal_camera = health_.Get(Sensor::kThermal);
  status.spool_frames = pipeline_.frames_lacking();
  status.frames_gone = pipeline_.frames_gone();
  AddHostStatus(host_.read(), status);
  if (const std::optional<SpoolStatus> recording = pipeline_.recording()) {
    status.disk_free_bytes = ToReport(recording->free_bytes);
    status.spool_bytes = static_cast<std::uint64_t>(static_cast<double>(status.spool_frames) *
                                                    recording->frame_bytes);
    status.spool_keeps_s = recording->keeps_s;
  }
  status.marks = pipeline_.marks();
  status.clock.steps = pipeline_.clock_steps();
  status.clock.step_sum_s = ToSeconds(pipeline_.clock_step_total());
  return status;
}

void EdgeMonitor::LogCameras(const EdgeStatus& before) const {
  const auto tell = [](std::string_view name, const CameraReport& was, const CameraReport& is) {
    // A camera may have been lost and be back between two looks.
    if (is.state == CameraState::kNone || (was.state == is.state && was.failures == is.failures)) {
      return;
    }
    if (is.state == CameraState::kWorking) {
      LOG(Edge, Info) << name << " camera: " << CameraText(is.state)
                      << ", failures=" << is.failures;
    } else {
      LOG(Edge, Warning) << name << " camera: " << CameraText(is.state)
                         << ", failures=" << is.failures;
    }
  };
  tell("depth", before.depth_camera, status_.depth_camera);
  tell("thermal", before.thermal_camera, status_.thermal_camera);
}

void EdgeMonitor::LogClock() {
  const bool synchronised = status_.clock.synchronised;
  if (std::exchange(synchronised_, synchronised) == synchronised) return;
  if (synchronised) {
    LOG(Edge, Info) << "the wall clock is " << ToText(status_.clock);
  } else {
    LOG(Edge, Warning) << *ClockProblem({});
  }
}

void EdgeMonitor::ShowFeedback() {
  const std::uint64_t count = pipeline_.feedback().latency().count;
  if (count == feedback_shown_) return;
  feedback_shown_ = count;
  const std::optional<Feedback> feedback = pipeline_.feedback().newest();
  if (!image_file_.empty() && !feedback->image.empty()) {
    const Status written = ReplaceFile(image_file_, feedback->image);
    if (!written.ok() && !image_fails_) {
      LOG(Edge, Warning) << "no confidence image: " << written.message();
    }
    image_fails_ = !written.ok();
  }
  const std::optional<std::string> news = reporter_.Report(*feedback);
  ShowLine();
  if (!terminal_ && news) {
    LOG(Edge, Info) << "ground: " << *news;
  }
}

EdgeSituation EdgeMonitor::Situation() const {
  const PublisherStats link = publisher_.stats();
  EdgeSituation situation{.status = status_,
                          .depth = counters_.Get(Sensor::kDepth),
                          .thermal = counters_.Get(Sensor::kThermal),
                          .ground_present = link.ground_present,
                          .ground_problem = link.ground_problem,
                          .feedback = pipeline_.feedback().newest(),
                          .feedback_age = pipeline_.feedback().age(clock_.Now()),
                          .receipt_age = link.receipt_age};
  if (const auto recording = pipeline_.recording()) {
    situation.disk_left_s = recording->left_s;
    if (!recording->brief.empty()) situation.problems.push_back(recording->brief);
  }
  if (!link.problem.empty()) situation.problems.emplace_back("NO NETWORK");
  if (!link.ground_problem.empty()) situation.problems.push_back("GROUND " + link.ground_problem);
  if (const std::optional<std::string> stuck = pipeline_.StuckIn(clock_.SteadyNow()))
    situation.problems.push_back(*stuck);
  return situation;
}

void EdgeMonitor::ShowLine() {
  if (terminal_ && line_) line_->Show(StatusParts(Situation()), "  ");
}

std::vector<std::string> EdgeMonitor::Problems() const {
  std::vector<std::string> problems;
  if (const std::optional<std::string> stuck = pipeline_.StuckIn(clock_.SteadyNow()))
    problems.push_back(*stuck);
  if (const auto recording = pipeline_.recording(); recording && !recording->problem.empty())
    problems.push_back("not recording: " + recording->problem);
  const PublisherStats link = publisher_.stats();
  if (!link.problem.empty()) problems.push_back(link.problem);
  if (!link.ground_problem.empty()) problems.push_back("the ground station " + link.ground_problem);
  const auto look = [&problems](std::string_view name, const CameraReport& camera) {
    if (camera.state == CameraState::kLost) {
      problems.push_back(std::string(name) + " camera is lost: look at its cable and power; " +
                         "it is opened again as soon as it is there");
    }
  };
  look("the depth", status_.depth_camera);
  look("the thermal", status_.thermal_camera);
  return problems;
}

void EdgeMonitor::ReportStatus() {
  std::vector<std::string> problems = Problems();
  // Said when it changes: the service manager shows the last text until then.
  if (problems == reported_ && is_said_) return;
  reported_ = std::move(problems);
  std::string text;
  for (const std::string& problem : reported_) text += (text.empty() ? "" : "; ") + problem;
  is_said_ = host_.notify_status(text.empty() ? "all is well again" : text);
}

void EdgeMonitor::Log() {
  if (clock_.SteadyNow() < next_log_) return;
  next_log_ += kLogInterval;
  const std::string line = StatusLine(Situation());
  if (!terminal_) {
    LOG(Edge, Info) << line;
  }
  if (reported_.empty()) host_.notify_status(line);
}

bool EdgeMonitor::GetsOn(SteadyTime now) {
  const auto sends = [&](Sensor sensor, Newest* newest) {
    const CameraState state = health_.Get(sensor).state;
    const bool is_due = state == CameraState::kWorking || state == CameraState::kBlind;
    const std::uint64_t captured = counters_.Get(sensor).captured;
    // A camera that is lost is looked for: that is progress. So is a source that has ended.
    if (std::exchange(newest->captured, captured) != captured || !is_due ||
        pipeline_.source_ended())
      newest->at = now;
    return now - newest->at <= kNoFrames;
  };
  const bool depth_sends = sends(Sensor::kDepth, &newest_depth_);
  const bool thermal_sends = sends(Sensor::kThermal, &newest_thermal_);
  std::optional<std::string> stuck = pipeline_.StuckIn(now);
  if (!stuck && !depth_sends) stuck = "the depth camera sends nothing and does not fail";
  if (!stuck && !thermal_sends) stuck = "the thermal camera sends nothing and does not fail";
  if (stuck.has_value() != std::exchange(stuck_, stuck.has_value())) {
    LOG(Edge, Error) << (stuck ? *stuck + ": the service manager is no longer told that all is well"
                               : "it goes on");
  }
  return !stuck;
}

void EdgeMonitor::FeedWatchdog(SteadyTime now) {
  if (now < next_feed_) return;
  next_feed_ = now + host_.watchdog_interval.value_or(kStatusInterval);
  if (GetsOn(now) && host_.watchdog_interval) host_.notify_alive();
}

}  // namespace isotherm
