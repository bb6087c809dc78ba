#include "edge/daemon/open_source.h"

#include <algorithm>
#include <future>
#include <string>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/service.h"
#include "common/time/back_off.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using Opened = Result<std::unique_ptr<FrameSource>>;

/// How often a service that waits says that it is alive.
constexpr Nanoseconds kReportInterval = std::chrono::milliseconds(500);
/// A camera's process that does not open it is killed after half of this, and then tried again: an
/// attempt that takes longer hangs in this process.
constexpr Nanoseconds kMaxAttempt = std::chrono::seconds(30);

/// Trying again may help.
bool IsMissing(const Opened& source) {
  return !source && source.error().code() == StatusCode::kUnavailable;
}

/// Opens the cameras again and again. Thread-bound.
class Waiting {
 public:
  Waiting(const EdgeOptions& options, const SourceContext& context)
      : options_(options), context_(context) {}

  Opened Try() {
    Opened source = MakeSource(options_, context_, told_makes_);
    if (!source) return source;
    if (const Status opened = (*source)->Open(); !opened.ok()) return Err(opened);
    return source;
  }

  Opened UntilOpened(Opened source) {
    const FrameCheckOptions& pace = options_.frame_check();
    BackOff back_off(FromSeconds(pace.expert().retry_min_s()),
                     FromSeconds(pace.expert().retry_max_s()));
    while (IsMissing(source) && !context_.stop.stop_requested()) {
      Report(source.error().message());
      Wait(back_off.Next());
      // A vendor's library may take its time; the service manager is told meanwhile.
      std::future<Opened> attempt = std::async(std::launch::async, [this] { return Try(); });
      Await(attempt);
      source = attempt.get();
    }
    return source;
  }

 private:
  /// Once, and again if something else is the matter.
  void Report(const std::string& reason) {
    if (std::exchange(reason_, reason) == reason) return;
    LOG(Edge, Warning) << reason << "; waiting for it, nothing is recorded yet";
  }
  void NotifyAlive() const { NotifyWaiting("waiting for a camera: " + reason_); }

  void Wait(Nanoseconds duration) const {
    const SteadyTime due = context_.clock.SteadyNow() + duration;
    while (context_.clock.SteadyNow() < due && !context_.stop.stop_requested()) {
      NotifyAlive();
      Pause(context_.stop,
            std::min(kReportInterval, Nanoseconds(due - context_.clock.SteadyNow())));
    }
  }

  void Await(std::future<Opened>& attempt) const {
    const SteadyTime begun = context_.clock.SteadyNow();
    while (attempt.wait_for(kReportInterval) != std::future_status::ready) {
      if (context_.clock.SteadyNow() - begun > kMaxAttempt) {
        LOG(Edge, Error) << "the library of a camera has not come back from opening it for "
                         << ToSeconds(kMaxAttempt)
                         << " s: the service manager is no longer told that all is well";
        do {
          NotifyStatus("the library of a camera does not come back from opening it");
        } while (attempt.wait_for(kReportInterval) != std::future_status::ready);
        return;
      }
      NotifyAlive();
    }
  }

  const EdgeOptions& options_;
  const SourceContext& context_;
  std::string reason_;
  ToldProblems told_makes_;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenSource(const EdgeOptions& options,
                                                const SourceContext& context) {
  Waiting waiting(options, context);
  Opened source = waiting.Try();
  const bool waits = options.source().kind() == CAMERAS && !options.exit_at_end();
  return waits ? waiting.UntilOpened(std::move(source)) : std::move(source);
}

}  // namespace isotherm
