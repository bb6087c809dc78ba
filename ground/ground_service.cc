#include "ground/ground_service.h"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/exit_deadline.h"
#include "common/base/log.h"
#include "common/base/service.h"
#include "common/transport/join_domain.h"
#include "ground/distributor.h"
#include "ground/export/results.h"
#include "ground/reconstruction_loop.h"
#include "ground/recording_loop.h"
#include "ground/status_teller.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// All results are written by then. With its network interface down, the middleware never ends.
constexpr auto kTimeToLeaveNetwork = 500ms;

/// Feeds the service manager's watchdog while frames move or nothing waits, and tells the status.
void GuardUntilStopped(const std::stop_token& stop, const ItemQueue& queue,
                       const ReconstructionLoop& loop, const Subscriber& subscriber,
                       const Clock& clock) {
  const auto interval = WatchdogInterval().value_or(std::chrono::microseconds(500ms));
  StatusTeller status(clock);
  std::uint64_t seen = 0;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!wake.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
    const std::uint64_t processed = loop.processed();
    if (processed != seen || queue.size() == 0) NotifyWatchdog();
    seen = processed;
    status.Tell(subscriber.stats());
  }
}

int Fail(const Status& status) {
  LOG(Ground, Error) << status.message();
  return ExitCode(status);
}

/// Somebody who waits for one scan wants to know at once that the network is not there.
Result<std::unique_ptr<Participant>> Join(int domain, const ServiceMode& mode,
                                          const TransportEnvironment& environment,
                                          const Clock& clock, const std::stop_token& stop) {
  if (mode.single_scan) return Participant::Create(environment, domain);
  return JoinDomain(environment, domain, clock, stop,
                    [](const Status& reason) { NotifyWaiting(reason.message()); });
}

}  // namespace

int RunGround(const GroundOptions& options, const ServiceMode& mode,
              const TransportEnvironment& environment, const Clock& clock, StopSignal& signal) {
  if (const Status prepared = PrepareOutputDir(options.live().output_dir()); !prepared.ok())
    return Fail(prepared);
  ExitDeadline leaving;  // Outlives the participant.
  const Result<std::unique_ptr<Participant>> participant =
      Join(options.live().domain(), mode, environment, clock, signal.token());
  if (!participant) return signal.token().stop_requested() ? 0 : Fail(participant.error());

  const auto capacity = static_cast<std::size_t>(options.live().queue_frames());
  ItemQueue to_reconstruction(capacity, OverflowPolicy::kBlock);
  ItemQueue to_recording(capacity, OverflowPolicy::kBlock);
  Distributor distributor(options, mode.single_scan, clock, to_reconstruction, to_recording);

  SubscriberOptions subscriber_options;
  subscriber_options.edge_id = options.live().edge_id();
  subscriber_options.software_version = ISOTHERM_VERSION;
  subscriber_options.reorder_window = FromSeconds(options.live().reorder_window_s());
  subscriber_options.max_clock_offset = FromSeconds(options.live().max_clock_offset_s());
  SubscriberHandlers handlers;
  handlers.depth = [&](ReceivedDepth depth) { distributor.OnFrame(std::move(depth)); };
  handlers.thermal = [&](ReceivedThermal thermal) { distributor.OnFrame(std::move(thermal)); };
  handlers.late_depth = [&](ReceivedDepth depth) { distributor.OnLate(std::move(depth)); };
  handlers.late_thermal = [&](ReceivedThermal thermal) { distributor.OnLate(std::move(thermal)); };
  handlers.outside_pose = [&](const OutsidePoseSample& pose) { distributor.OnFrame(pose); };
  handlers.rig = [&](const RigDescription& rig) { distributor.OnRig(rig); };
  handlers.clock = [&](const ClockAccount& account) { distributor.OnClock(account); };
  handlers.session_end = [&](const SessionAccount& account) { distributor.OnSessionEnd(account); };
  const Result<std::unique_ptr<Subscriber>> subscriber =
      Subscriber::Create(**participant, clock, subscriber_options, std::move(handlers));
  if (!subscriber) return Fail(subscriber.error());

  RecordingLoop recording(options);
  ReconstructionLoop reconstruction(options, mode, clock, **subscriber, to_recording, signal);
  {
    std::jthread recording_thread(
        [&](const std::stop_token& stop) { recording.Run(to_recording, stop); });
    std::jthread reconstruction_thread(
        [&](const std::stop_token& stop) { reconstruction.Run(to_reconstruction, stop); });
    std::jthread receive_thread([&](const std::stop_token& stop) {
      distributor.SetStop(stop);
      (*subscriber)->Run(stop);
    });
    NotifyReady("waiting for an edge");
    LOG(Ground, Info) << "ready, domain=" << options.live().domain() << " edge_id=\""
                      << options.live().edge_id()
                      << "\" output_dir=" << options.live().output_dir();
    GuardUntilStopped(signal.token(), to_reconstruction, reconstruction, **subscriber, clock);
    NotifyStopping();
    // Reception first; then each consumer empties its queue and closes its files.
    receive_thread.request_stop();
    receive_thread.join();
    recording_thread.request_stop();
    reconstruction_thread.request_stop();
  }
  const int exit_code =
      ExitCode(recording.status().ok() ? reconstruction.status() : recording.status());
  leaving.Arm(kTimeToLeaveNetwork, exit_code, "the middleware");
  return exit_code;
}

}  // namespace isotherm
