#include "edge/daemon/idle_rig.h"

#include <thread>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/processor_time.h"
#include "common/base/service.h"
#include "common/concurrency/bounded_queue.h"
#include "edge/daemon/edge_report.h"
#include "edge/daemon/host_status.h"
#include "edge/daemon/stop_limits.h"

namespace isotherm {
namespace {

/// As during a scan.
constexpr Nanoseconds kIdleStatusInterval = std::chrono::seconds(1);
/// Orders come one at a time; whoever sends more is answered later.
constexpr std::size_t kMaxOrders = 16;
constexpr const char* kWaiting = "no scan yet: waiting for the order to start one";

/// Returns the answer to an order; kDone for the one that is waited for.
CommandResult AnswerTo(const Command& order, Publisher& publisher) {
  if (order.kind == CommandKind::kStartScan)
    return {order.number, CommandOutcome::kDone, "the scan begins once the cameras are open"};
  if (order.kind == CommandKind::kSetPublishPolicy) {
    publisher.SetPolicy(order.publish_policy);
    return {order.number, CommandOutcome::kDone, ""};
  }
  return {order.number, CommandOutcome::kRefused,
          "no scan is under way, and the cameras are closed; start one first"};
}

}  // namespace

bool WaitForScanOrder(Publisher& publisher, const Clock& clock, const std::stop_token& stop) {
  BoundedQueue<Command> orders(kMaxOrders, OverflowPolicy::kDropOldest);
  const std::jthread receiving([&](const std::stop_token& ended) {
    NameThread("receive");
    PublisherHandlers handlers;
    handlers.command = [&orders](const Command& command) { orders.Push(command, {}); };
    publisher.Run(ended, handlers);
  });
  NotifyReady(kWaiting);
  LOG(Edge, Info) << kWaiting << " (isotherm scan --start, or the console)";
  SteadyTime next_status = clock.SteadyNow();
  for (; !stop.stop_requested(); Pause(stop, stop_limits::kTick)) {
    NotifyWatchdog();
    while (orders.size() > 0) {
      const Command order = *orders.Pop({});
      const CommandResult answer = AnswerTo(order, publisher);
      if (const Status answered = publisher.Answer(answer); !answered.ok()) {
        LOG(Edge, Warning) << "command not answered: " << answered.message();
      }
      if (order.kind == CommandKind::kStartScan) return true;
    }
    if (clock.SteadyNow() < next_status) continue;
    next_status += kIdleStatusInterval;
    EdgeStatus status;
    status.time = clock.Now();
    AddHostStatus(ReadHostStatus("."), status);
    if (const Status published = publisher.Publish(status); !published.ok()) {
      LOG(Edge, Debug) << "status not published: " << published.message();
    }
    NotifyStatus(kWaiting);
  }
  return false;
}

}  // namespace isotherm
