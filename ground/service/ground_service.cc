#include "ground/service/ground_service.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "common/base/exit_deadline.h"
#include "common/base/freed_memory.h"
#include "common/base/host_name.h"
#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/service.h"
#include "common/concurrency/worker.h"
#include "common/transport/address_watch.h"
#include "common/transport/join_domain.h"
#include "common/transport/network_addresses.h"
#include "ground/console/console.h"
#include "ground/export/result_files.h"
#include "ground/service/console_state.h"
#include "ground/service/distributor.h"
#include "ground/service/health.h"
#include "ground/service/output_folder.h"
#include "ground/service/reconstruction_loop.h"
#include "ground/service/recording_loop.h"
#include "ground/service/result_writer.h"
#include "ground/service/scan_board.h"
#include "ground/service/status_reporter.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// A turn of its threads takes milliseconds, but the one that keeps shapes may wait for the disk.
constexpr auto kTimeToLeaveConsole = 1s;
// All results are written by then. With its network interface down, the middleware never ends.
constexpr auto kTimeToLeaveNetwork = 500ms;

int Fail(const Status& status) {
  LOG(Ground, Error) << status.message();
  return ExitCode(status);
}

/// Six seconds of a rig's frames.
constexpr RecordingQueue::Limits kRecordingLimits{.items = 450, .bytes = 128U << 20};

/// A disk may be slow for longer than the service manager lets the service be silent, but not for
/// ever.
Nanoseconds DiskLimit() {
  // Eighteen times the watchdog's interval: a minute with the shipped unit's. A laptop's disk may
  // spin up or a stick collect for seconds; longer is a fault. Not tuned.
  constexpr int kIntervals = 18;
  constexpr std::chrono::microseconds kUnwatched = 3333ms;
  return kIntervals * Nanoseconds(WatchdogInterval().value_or(kUnwatched));
}

/// The service's threads and what joins them. Thread-bound to the main thread.
class GroundService {
 public:
  GroundService(const GroundOptions& options, const ServiceMode& mode,
                const TransportEnvironment& environment, const Clock& clock, StopSignal& signal)
      : options_(options),
        mode_(mode),
        environment_(environment),
        clock_(clock),
        signal_(signal),
        health_(DiskLimit()),
        to_reconstruction_(static_cast<std::size_t>(options.live().expert().queue_frames()),
                           OverflowPolicy::kBlock),
        to_recording_(kRecordingLimits),
        distributor_(options, mode.single_scan, clock,
                     {to_reconstruction_, to_recording_, board_, health_.receive}),
        output_folder_(options.live().output_dir(), &PrepareOutputDir) {}

  /// Joins the link.
  Status Open();
  /// Serves until the signal, then lets everything end. The exit status.
  int Run();

 private:
  SubscriberOptions LinkOptions() const;
  SubscriberHandlers Handlers();
  /// Tells the service manager that all is well, while it is, and the operator how it goes.
  void GuardUntilStopped();
  void FeedWatchdog();
  Result<std::unique_ptr<Participant>> JoinNetwork(bool waits);
  /// Joins the link anew if this computer has moved in its network.
  void FollowNetwork();
  /// Thread-safe.
  GroundSituation Situation(std::optional<std::string> problem) const;
  void OpenConsole();
  /// The console goes on to show a scan that has ended until the next one begins.
  void ShowEnded(std::unique_ptr<LiveScan> scan);
  /// Waits for a thread's end as long as what it needs goes on, and leaves without it otherwise.
  void WaitForEnd(Worker& worker, GroundThread thread);
  /// Ends the process although a thread is stuck in it.
  [[noreturn]] void LeaveBehind(GroundThread stuck);
  std::string StuckText(GroundThread stuck) const;

  const GroundOptions& options_;
  const ServiceMode mode_;
  const TransportEnvironment& environment_;
  const Clock& clock_;
  StopSignal& signal_;
  AddressWatch addresses_{""};
  ScanBoard board_;
  Health health_;
  SessionQueue to_reconstruction_;
  RecordingQueue to_recording_;
  Distributor distributor_;
  ExitDeadline leaving_;  // Outlives the participant.
  std::unique_ptr<Participant> participant_;
  std::unique_ptr<Subscriber> subscriber_;
  OutputFolder output_folder_;
  std::unique_ptr<Console> console_;  // nullptr if it is not wanted, or not to be had.
  SteadyTime next_feed_{};
  std::optional<std::string> reported_problem_;
};

SubscriberOptions GroundService::LinkOptions() const {
  SubscriberOptions link;
  link.edge_id = options_.live().edge_id();
  link.software_version = ISOTHERM_VERSION;
  link.reorder_window = FromSeconds(options_.live().expert().reorder_window_s());
  link.max_clock_offset = FromSeconds(options_.live().expert().max_clock_offset_s());
  return link;
}

/// The way from the subscriber to the distributor: what each message of the link calls there.
SubscriberHandlers GroundService::Handlers() {
  SubscriberHandlers handlers;
  Distributor& to = distributor_;
  handlers.depth = [&to](ReceivedDepth depth) { to.OnItem(std::move(depth)); };
  handlers.thermal = [&to](ReceivedThermal thermal) { to.OnItem(std::move(thermal)); };
  handlers.late_depth = [&to](ReceivedDepth depth) { to.OnLate(std::move(depth)); };
  handlers.late_thermal = [&to](ReceivedThermal thermal) { to.OnLate(std::move(thermal)); };
  handlers.external_odometry = [&to](const ExternalOdometrySample& pose) { to.OnItem(pose); };
  handlers.rig = [&to](const RigDescription& rig) { to.OnRig(rig); };
  handlers.clock = [&to](const SessionClock& clock) { to.OnClock(clock); };
  handlers.mark = [&to](const SessionMark& mark) { to.OnMark(mark); };
  handlers.session_end = [&to](const SessionCounters& counters) { to.OnSessionEnd(counters); };
  handlers.status = [this](const EdgeStatus& status) { board_.edge.Set(status); };
  handlers.command_result = [this](const CommandResult& result) {
    if (console_) console_->OnCommandResult(result);
  };
  handlers.turn = [this] { health_.receive.Busy(clock_.SteadyNow()); };
  return handlers;
}

Result<std::unique_ptr<Participant>> GroundService::JoinNetwork(bool waits) {
  const int domain = options_.live().domain();
  const Announcement announcement{Role::kGround, "", HostName()};
  addresses_ = AddressWatch(NetworkAddresses());
  if (!waits) return Participant::Create(environment_, domain, announcement);
  const auto waiting = [this](const Status& reason) {
    addresses_ = AddressWatch(NetworkAddresses());
    if (!subscriber_) return NotifyWaiting(reason.message());
    // All threads are at work: they are to be well, too.
    NotifyStatus(reason.message());
    FeedWatchdog();
  };
  return JoinDomain(environment_, domain, clock_, signal_.token(), waiting, announcement);
}

Status GroundService::Open() {
  // Somebody who waits for one scan wants to know at once that the network is not there.
  Result<std::unique_ptr<Participant>> participant = JoinNetwork(/*waits=*/!mode_.single_scan);
  if (!participant) return participant.error();
  participant_ = std::move(*participant);
  Result<std::unique_ptr<Subscriber>> subscriber =
      Subscriber::Create(*participant_, clock_, LinkOptions(), Handlers());
  if (!subscriber) return subscriber.error();
  subscriber_ = std::move(*subscriber);
  return OkStatus();
}

void GroundService::FollowNetwork() {
  const SubscriberStats link = subscriber_->stats();
  const SteadyTime now = clock_.SteadyNow();
  const Nanoseconds silent_for = link.edge_present ? Nanoseconds(0)
                                 : link.edge_lost  ? now - *link.edge_lost
                                                   : AddressWatch::kSilence;
  if (!addresses_.HasMoved(NetworkAddresses(), silent_for, now)) return;
  LOG(Ground, Warning) << "this computer's addresses have changed, and the rig is silent: joining "
                          "the network anew";
  const bool left = subscriber_->Leave([this] {
    FeedWatchdog();
    return !signal_.token().stop_requested();
  });
  if (!left) return;
  participant_.reset();
  Result<std::unique_ptr<Participant>> joined = JoinNetwork(/*waits=*/true);
  if (joined) {
    participant_ = std::move(*joined);
    if (const Status status = subscriber_->Join(*participant_); status.ok()) return;
  }
  if (signal_.token().stop_requested()) return;
  LOG(Ground, Error) << "the network cannot be joined; it is tried again";
  addresses_ = AddressWatch("");
}

void GroundService::OpenConsole() {
  if (!options_.console().enabled()) return;
  ConsoleServices services;
  services.send = [this](const Command& command) { return subscriber_->Send(command); };
  services.describe = [this](live::State& state) {
    DescribeSituation(Situation(health_.Problem(clock_.SteadyNow())), state);
  };
  Result<std::unique_ptr<Console>> console = Console::Start(options_, clock_, std::move(services));
  if (!console) {
    LOG(Ground, Warning) << "there is no console: " << console.error().message()
                         << "; everything else goes on (console.port sets another port, "
                            "console.enabled=false turns it off)";
    return;
  }
  console_ = std::move(*console);
  LOG(Ground, Info) << console_->HowToComeIn(::isatty(STDERR_FILENO) == 1);
}

void GroundService::ShowEnded(std::unique_ptr<LiveScan> scan) {
  if (!console_ || !scan || scan->shown_scan() == 0) return;
  const std::shared_ptr<LiveScan> kept = std::move(scan);
  const Atlas& atlas = kept->model().atlas;
  std::vector<ReadableMap> maps;
  for (int i = 0; i < atlas.size(); ++i) {
    const SubMap& map = atlas.map(i);
    maps.push_back({.tsdf = {kept, map.tsdf.get()},
                    .thermal = {kept, map.thermal.get()},
                    .place = {map.T_world_map, map.joined}});
  }
  console_->EndScan(kept->shown_scan(), std::move(maps));
}

int GroundService::Run() {
  OpenConsole();
  const ResultWriter::Handlers handlers{
      .written = [this](std::unique_ptr<LiveScan> scan) { ShowEnded(std::move(scan)); },
      .completed =
          [this] {
            if (mode_.single_scan) signal_.Request();
          }};
  const auto counters = [this](std::uint64_t session) { return subscriber_->counters(session); };
  ResultWriter results(options_, clock_, counters, board_, health_.results, handlers);
  RecordingLoop recording(options_, clock_, board_, health_.recording);
  ReconstructionLoop reconstruction(
      options_, clock_,
      {*subscriber_, to_recording_, results, board_, health_.reconstruction, health_.reading,
       console_ ? &console_->feed() : nullptr});
  {
    // Consumers are started before the producers, and stopped behind them below.
    Worker result_thread("results", [&](const std::stop_token& stop) { results.Run(stop); });
    Worker recording_thread(
        "record", [&](const std::stop_token& stop) { recording.Run(to_recording_, stop); });
    Worker reconstruction_thread("reconstruct", [&](const std::stop_token& stop) {
      reconstruction.Run(to_reconstruction_, stop);
    });
    Worker receive_thread("receive", [&](const std::stop_token& stop) {
      distributor_.SetStop(stop);
      subscriber_->Run(stop);
      health_.receive.Idle();
    });
    NotifyReady("waiting for an edge");
    LOG(Ground, Info) << "ready, domain=" << options_.live().domain() << " edge_id=\""
                      << options_.live().edge_id()
                      << "\" output_dir=" << options_.live().output_dir();
    GuardUntilStopped();
    NotifyStopping();
    // Reception first; then each consumer empties its queue and closes its files.
    receive_thread.RequestStop();
    WaitForEnd(receive_thread, GroundThread::kReception);
    // Both consumers at once: each empties its queue, and the recording must not wait for the
    // model.
    recording_thread.RequestStop();
    reconstruction_thread.RequestStop();
    WaitForEnd(reconstruction_thread, GroundThread::kReconstruction);
    result_thread.RequestStop();
    WaitForEnd(result_thread, GroundThread::kResults);
    // Last: its file closes while the results are written, and they tell whether it is complete.
    WaitForEnd(recording_thread, GroundThread::kRecording);
  }
  int exit_code = 0;
  for (const Status& status : {recording.status(), results.status(), reconstruction.status()}) {
    if (exit_code == 0) exit_code = ExitCode(status);
  }
  leaving_.Arm(kTimeToLeaveConsole, exit_code, "the console");
  console_.reset();
  leaving_.Arm(kTimeToLeaveNetwork, exit_code, "the middleware");
  return exit_code;
}

void GroundService::GuardUntilStopped() {
  // The status line changes once a second, and a watchdog waits for seconds: five looks a second
  // are enough, and cost nothing.
  constexpr Nanoseconds kTick = 200ms;
  StatusReporter status(clock_);
  FreedMemory freed;
  const std::stop_token stop = signal_.token();
  for (Pause(stop, kTick); !stop.stop_requested(); Pause(stop, kTick)) {
    FeedWatchdog();
    FollowNetwork();
    output_folder_.Tend(clock_.SteadyNow());
    status.Report(Situation(reported_problem_));
    freed.GiveBackIfDue(clock_.SteadyNow());
  }
}

void GroundService::FeedWatchdog() {
  const SteadyTime now = clock_.SteadyNow();
  const std::optional<std::string> problem = health_.Problem(now);
  if (problem && !reported_problem_) {
    LOG(Ground, Error) << *problem << "; the service manager is not told any more that all is well";
  } else if (!problem && reported_problem_) {
    LOG(Ground, Info) << "all goes on again";
  }
  reported_problem_ = problem;
  if (problem || now < next_feed_) return;
  // Without a watchdog nobody waits for the notification.
  constexpr std::chrono::microseconds kUnwatched = 1s;
  next_feed_ = now + WatchdogInterval().value_or(kUnwatched);
  NotifyWatchdog();
}

GroundSituation GroundService::Situation(std::optional<std::string> problem) const {
  const SubscriberStats link = subscriber_->stats();
  const Nanoseconds lost_for =
      link.edge_lost ? clock_.SteadyNow() - *link.edge_lost : Nanoseconds(0);
  GroundSituation situation{.link = link,
                            .rig_lost_for = lost_for,
                            .feedback = board_.feedback.Get(),
                            .edge = board_.edge.Get(),
                            .behind = board_.behind.Get().value_or(BehindCounts()),
                            .recording = {},
                            .rebuilt_fraction = board_.rebuilt_fraction.Get(),
                            .recording_at_it = health_.recording.AtItFor(clock_.SteadyNow()),
                            .scans_being_written = board_.scans_being_written,
                            .scans_given_up = board_.scans_given_up,
                            .problem = std::move(problem),
                            .moved_calibration = board_.calibration.Get().value_or(""),
                            .folder_problem = output_folder_.problem()};
  if (const auto tracker = board_.recording.Get()) situation.recording = (*tracker)->Get();
  return situation;
}

void GroundService::WaitForEnd(Worker& worker, GroundThread thread) {
  constexpr Nanoseconds kTick = 50ms;
  // The service manager kills after its time to stop; it is asked for more as long as what is
  // waited for goes on.
  constexpr std::chrono::microseconds kExtension = 10s;
  while (!worker.WaitForEnd(kTick)) {
    if (const auto stuck = health_.StuckBeforeEnd(thread, clock_.SteadyNow())) LeaveBehind(*stuck);
    NotifyExtendTimeout(kExtension);
    FeedWatchdog();
  }
}

std::string GroundService::StuckText(GroundThread stuck) const {
  switch (stuck) {
    case GroundThread::kReception:
      return "reception is stuck";
    case GroundThread::kReconstruction:
      return "the reconstruction is stuck";
    case GroundThread::kResults:
      return "the disk is stuck: results are not complete, output_dir=" +
             options_.live().output_dir();
    case GroundThread::kRecording:
      break;
  }
  const auto tracker = board_.recording.Get();
  return "the disk is stuck: the recording is not complete, file=" +
         (tracker ? (*tracker)->Get().path.string() : "?");
}

void GroundService::LeaveBehind(GroundThread stuck) {
  const int exit_code = ExitCode(IoError(""));
  LOG(Ground, Error) << StuckText(stuck) << "; leaving without it";
  // The link is not torn down: the stuck thread may still use it. The rig notices within the lease.
  _exit(exit_code);
}

}  // namespace

int RunGround(const GroundOptions& options, const ServiceMode& mode,
              const TransportEnvironment& environment, const Clock& clock, StopSignal& signal) {
  if (mode.single_scan) {  // Somebody who waits for one scan wants to know at once.
    if (const Status prepared = PrepareOutputDir(options.live().output_dir()); !prepared.ok())
      return Fail(prepared);
  }
  GroundService service(options, mode, environment, clock, signal);
  if (const Status opened = service.Open(); !opened.ok())
    return signal.token().stop_requested() ? 0 : Fail(opened);
  return service.Run();
}

}  // namespace isotherm
