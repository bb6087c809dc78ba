#include "edge/housekeeping.h"

#include <unistd.h>

#include <cstdio>
#include <optional>
#include <utility>

#include "common/base/log.h"
#include "common/base/service.h"

namespace isotherm {
namespace {

constexpr Nanoseconds kStatusInterval = std::chrono::seconds(1);
constexpr Nanoseconds kLogInterval = std::chrono::seconds(10);

}  // namespace

Housekeeping::Housekeeping(const Clock& clock, EdgePipeline& pipeline, Publisher& publisher,
                           const FrameAccount& account, std::filesystem::path disk)
    : clock_(clock),
      pipeline_(pipeline),
      publisher_(publisher),
      account_(account),
      disk_(std::move(disk)),
      terminal_(isatty(STDERR_FILENO) == 1),
      next_status_(clock.SteadyNow()),
      next_log_(next_status_ + kLogInterval),
      watchdog_interval_(WatchdogInterval()),
      next_feed_(next_status_) {}

void Housekeeping::Tick() {
  pipeline_.AnswerCommands();
  const SteadyTime now = clock_.SteadyNow();
  FeedWatchdog(now);
  if (now < next_status_) return;
  next_status_ += kStatusInterval;
  const bool ended = pipeline_.finished();
  const EdgeStatus status = MakeStatus(ended ? ScanState::kEnded : ScanState::kScanning, now);
  const Status published = publisher_.Publish(status);
  if (!published.ok()) {
    LOG(Edge, Debug) << "status not published: " << published.message();
  }
  Show(status);
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
  status.nuc_state = pipeline_.nuc_state();
  status.spool_fill_ratio = pipeline_.spool_fill_ratio();
  AddHostStatus(ReadHostStatus(disk_), status);
  return status;
}

void Housekeeping::Show(const EdgeStatus& status) {
  const std::string line =
      StatusLine(status, account_, publisher_.stats().ground_present, publisher_.feedback().Get());
  if (terminal_) {
    // The cursor stays at the start of the line, so that a log line covers it.
    std::fprintf(stderr, "\033[2K%s\r", line.c_str());
    std::fflush(stderr);
  }
  if (clock_.SteadyNow() < next_log_) return;
  next_log_ += kLogInterval;
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
