#include "edge/housekeeping.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <optional>
#include <utility>

#include "common/base/log.h"
#include "common/base/service.h"
#include "common/transport/bounded_text.h"
#include "edge/picture_file.h"

namespace isotherm {
namespace {

constexpr Nanoseconds kStatusInterval = std::chrono::seconds(1);
constexpr Nanoseconds kLogInterval = std::chrono::seconds(10);

}  // namespace

Housekeeping::Housekeeping(const Clock& clock, EdgePipeline& pipeline, Publisher& publisher,
                           const FrameAccount& account, const CameraHealth& health,
                           std::filesystem::path disk, std::filesystem::path picture_file)
    : clock_(clock),
      pipeline_(pipeline),
      publisher_(publisher),
      account_(account),
      health_(health),
      disk_(std::move(disk)),
      picture_file_(std::move(picture_file)),
      terminal_(isatty(STDERR_FILENO) == 1),
      synchronised_(ReadKernelClock().synchronised),
      next_status_(clock.SteadyNow()),
      next_log_(next_status_ + kLogInterval),
      watchdog_interval_(WatchdogInterval()),
      next_feed_(next_status_) {}

void Housekeeping::Tick() {
  pipeline_.AnswerCommands();
  const SteadyTime now = clock_.SteadyNow();
  FeedWatchdog(now);
  ShowFeedback();
  if (now < next_status_) return;
  next_status_ += kStatusInterval;
  const bool ended = pipeline_.finished();
  const EdgeStatus before = std::exchange(status_, {});
  status_ = MakeStatus(ended ? ScanState::kEnded : ScanState::kScanning, now);
  TellCameras(before);
  TellClock();
  const Status published = publisher_.Publish(status_);
  if (!published.ok()) {
    LOG(Edge, Debug) << "status not published: " << published.message();
  }
  if (terminal_) ShowLine();
  Log();
}

void Housekeeping::PublishEnd() {
  const Status published = publisher_.Publish(MakeStatus(ScanState::kEnded, clock_.SteadyNow()));
  if (!published.ok()) {
    LOG(Edge, Warning) << "final status not published: " << published.message();
  }
  if (terminal_) std::fputs("\n", stderr);
}

EdgeStatus Housekeeping::MakeStatus(ScanState scan_state, SteadyTime now) {
  const SensorAccount depth = account_.Get(Sensor::kDepth);
  const SensorAccount thermal = account_.Get(Sensor::kThermal);
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
  AddHostStatus(ReadHostStatus(disk_), status);
  status.clock.steps = pipeline_.clock_steps();
  status.clock.step_sum_s = ToSeconds(pipeline_.clock_step_total());
  return status;
}

void Housekeeping::TellCameras(const EdgeStatus& before) const {
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

void Housekeeping::TellClock() {
  const bool synchronised = status_.clock.synchronised;
  if (std::exchange(synchronised_, synchronised) == synchronised) return;
  if (synchronised) {
    LOG(Edge, Info) << "the wall clock is " << ToText(status_.clock);
  } else {
    LOG(Edge, Warning) << *ClockProblem({});
  }
}

void Housekeeping::ShowFeedback() {
  const std::uint64_t count = pipeline_.feedback().latency().count;
  if (count == feedback_shown_) return;
  feedback_shown_ = count;
  const std::optional<Feedback> feedback = pipeline_.feedback().newest();
  if (!picture_file_.empty() && !feedback->picture.empty()) {
    const Status written = ReplaceFile(picture_file_, feedback->picture);
    if (!written.ok() && !picture_fails_) {
      LOG(Edge, Warning) << "no confidence picture: " << written.message();
    }
    picture_fails_ = !written.ok();
  }
  const std::optional<std::string> news = narrator_.Tell(*feedback);
  if (terminal_) {
    ShowLine();
  } else if (news) {
    LOG(Edge, Info) << "ground: " << *news;
  }
}

void Housekeeping::ShowLine() {
  const std::string line = StatusLine(status_, account_, publisher_.stats().ground_present,
                                      pipeline_.feedback().newest());
  // A line that wraps cannot be overwritten. The cursor stays at its start, so that a log line
  // covers it.
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  const std::size_t columns = known ? size.ws_col - 1U : line.size();
  std::fprintf(stderr, "\033[2K%s\r", std::string(CutText(line, columns)).c_str());
  std::fflush(stderr);
}

void Housekeeping::Log() {
  if (clock_.SteadyNow() < next_log_) return;
  next_log_ += kLogInterval;
  const std::string line = StatusLine(status_, account_, publisher_.stats().ground_present,
                                      pipeline_.feedback().newest());
  if (!terminal_) {
    LOG(Edge, Info) << line;
  }
  NotifyStatus(line);
}

void Housekeeping::FeedWatchdog(SteadyTime now) {
  if (!watchdog_interval_ || now < next_feed_) return;
  next_feed_ = now + *watchdog_interval_;
  // Only while frames move. A daemon whose source has ended is idle, not stuck.
  const std::uint64_t captured =
      account_.Get(Sensor::kDepth).captured + account_.Get(Sensor::kThermal).captured;
  if (captured == captured_at_last_feed_ && !pipeline_.finished()) return;
  captured_at_last_feed_ = captured;
  NotifyWatchdog();
}

}  // namespace isotherm
