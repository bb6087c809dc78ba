#include "ground/ground_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "common/base/log.h"
#include "common/base/service.h"
#include "common/concurrency/bounded_queue.h"
#include "common/transport/participant.h"
#include "ground/export/results.h"
#include "ground/link_account.h"
#include "ground/live_scan.h"
#include "ground/scan_recorder.h"
#include "ground/scan_result.h"
#include "ground/status_teller.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

struct RecordingOutcome {
  RecordingStats stats;
  Status status;
};

/// A new session: both consumers get the same folder; the reconstruction learns what was recorded.
struct SessionStart {
  RigDescription rig;
  std::filesystem::path folder;
  std::shared_ptr<std::promise<RecordingOutcome>> recording_promise;
  std::shared_future<RecordingOutcome> recording;
};

using Item = std::variant<SessionStart, ReceivedDepth, ReceivedThermal, OutsidePoseSample,
                          SessionAccount, Feedback, ClockAccount>;
using ItemQueue = BoundedQueue<Item>;

bool IsFrame(const Item& item) {
  return std::holds_alternative<ReceivedDepth>(item) ||
         std::holds_alternative<ReceivedThermal>(item);
}

/// Records one session after the other. Runs on the recording thread.
class RecordingLoop {
 public:
  explicit RecordingLoop(const GroundOptions& options) : options_(options) {}

  void Run(ItemQueue& queue, const std::stop_token& stop) {
    while (std::optional<Item> item = queue.Pop(stop)) {
      std::visit([this](const auto& value) { Handle(value); }, *item);
    }
    End();
  }
  const Status& status() const { return status_; }

 private:
  void Handle(const SessionStart& start) {
    End();
    promise_ = start.recording_promise;
    if (!options_.live().record()) return;
    Result<std::unique_ptr<ScanRecorder>> recorder =
        ScanRecorder::Create(start.folder / "scan.mcap", options_);
    if (!recorder) {
      LOG(Ground, Error) << "not recording: " << recorder.error().message();
      status_ = recorder.error();
      return;
    }
    recorder_ = std::move(*recorder);
    session_ = start.rig.session;
    recorder_->Write(start.rig);
  }
  void Handle(const SessionAccount& /*account*/) { End(); }
  void Handle(const Feedback& feedback) {
    // The reconstruction may be behind, and still speak of the session before.
    if (recorder_ && feedback.session == session_) recorder_->Write(feedback);
  }
  void Handle(const ClockAccount& clock) {
    if (recorder_ && clock.session == session_) recorder_->Write(clock);
  }
  template <typename Frame>
  void Handle(const Frame& frame) {
    if (recorder_) recorder_->Write(frame);
  }

  void End() {
    RecordingOutcome outcome;
    if (recorder_) {
      outcome.status = recorder_->Close();
      outcome.stats = recorder_->stats();
      if (!outcome.status.ok()) status_ = outcome.status;
      recorder_.reset();
    }
    if (promise_) {
      promise_->set_value(outcome);
      promise_.reset();
    }
  }

  const GroundOptions& options_;
  std::unique_ptr<ScanRecorder> recorder_;
  std::uint64_t session_ = 0;
  std::shared_ptr<std::promise<RecordingOutcome>> promise_;
  Status status_;
};

/// Reconstructs one session after the other. Runs on the reconstruction thread.
class ReconstructionLoop {
 public:
  /// `recording` gets the feedback.
  ReconstructionLoop(const GroundOptions& options, const ServiceMode& mode, const Clock& clock,
                     Subscriber& subscriber, ItemQueue& recording, StopSignal& signal)
      : clock_(clock),
        options_(options),
        mode_(mode),
        subscriber_(subscriber),
        recording_(recording),
        signal_(signal) {}

  void Run(ItemQueue& queue, const std::stop_token& stop) {
    stop_ = stop;
    while (std::optional<Item> item = queue.Pop(stop)) {
      if (stop.stop_requested() && IsFrame(*item)) {
        ++unprocessed_;
        continue;
      }
      std::visit([this](const auto& value) { Handle(value); }, *item);
    }
    End(subscriber_.stats().account);
  }
  const Status& status() const { return status_; }
  std::uint64_t processed() const { return processed_; }

 private:
  void Handle(const SessionStart& start) {
    End(last_account_);
    start_ = start;
    TellAboutCameras(start.rig);
    Result<std::unique_ptr<LiveScan>> scan = LiveScan::Create(clock_, options_, start.rig);
    if (!scan) {
      LOG(Ground, Error) << "session " << start.rig.session
                         << " is recorded only: " << scan.error().message();
      status_ = scan.error();
      return;
    }
    scan_ = std::move(*scan);
    LOG(Ground, Info) << "scan started, session=" << start.rig.session
                      << " results=" << start.folder.string();
    if (const Status& thermal = scan_->pipeline().thermal_status(); !thermal.ok()) {
      LOG(Ground, Warning) << thermal.message();
    }
  }

  void Handle(const SessionAccount& account) {
    last_account_ = account;
    End(account);
    if (mode_.single_scan) signal_.Request();
  }

  void Handle(const OutsidePoseSample& sample) {
    if (scan_) scan_->Add(sample);
  }

  template <typename Frame>
  void Handle(const Frame& frame) {
    if (!scan_) return;
    scan_->Add(frame);
    ++processed_;
    const std::optional<Feedback> feedback = scan_->TakeFeedback();
    if (!feedback) return;
    if (const Status status = subscriber_.Publish(*feedback); !status.ok()) {
      LOG(Ground, Debug) << "feedback not sent: " << status.message();
    }
    recording_.Push(*feedback, stop_);
    scan_->ThinkAhead();
  }
  void Handle(const Feedback& /*feedback*/) {}   // Comes from here.
  void Handle(const ClockAccount& /*clock*/) {}  // For the recording.

  void End(const SessionAccount& account) {
    if (!scan_) return;
    scan_->FinishFrames();
    Json stats = DescribeScan(scan_->pipeline(), options_, scan_->rig());
    Json& link = stats["link"];
    link["session"] = account.session;
    link["closed"] = account.closed;
    link["not_processed_at_stop"] = unprocessed_;
    link["waiting"] = DescribeStage(scan_->waiting());
    link["out_of_order_frames"] = scan_->out_of_order();
    if (scan_->outside_poses_received() > 0) {
      link["outside_poses"]["received"] = scan_->outside_poses_received();
      link["outside_poses"]["missing"] = scan_->outside_poses_missing();
    }
    RecordingOutcome recording;
    if (start_.recording.wait_for(1s) == std::future_status::ready)
      recording = start_.recording.get();
    DescribeAccount(account, recording.stats, link);
    stats["feedback"] = scan_->DescribeFeedback();
    const Result<std::string> text =
        WriteScan(scan_->pipeline(), options_, std::move(stats), start_.folder, nullptr);
    scan_.reset();
    if (!text) {
      status_ = text.error();
      LOG(Ground, Error) << status_.message();
      return;
    }
    const std::string summary = *text + AccountText(account, recording.stats);
    std::fputs(summary.c_str(), stdout);
    std::fflush(stdout);
  }

  const Clock& clock_;
  const GroundOptions& options_;
  const ServiceMode mode_;
  Subscriber& subscriber_;
  ItemQueue& recording_;
  StopSignal& signal_;
  std::stop_token stop_;
  SessionStart start_;
  std::unique_ptr<LiveScan> scan_;
  SessionAccount last_account_;
  std::uint64_t unprocessed_ = 0;
  std::atomic<std::uint64_t> processed_{0};
  Status status_;
};

/// Turns what the subscriber delivers into items for both consumers. Frames that arrive before
/// their session's calibration are kept until it is there. Bound to the receive thread.
class Distributor {
 public:
  Distributor(const GroundOptions& options, bool single_scan, const Clock& clock,
              ItemQueue& reconstruction, ItemQueue& recording)
      : options_(options),
        single_scan_(single_scan),
        clock_(clock),
        reconstruction_(reconstruction),
        recording_(recording) {}

  /// Reconstruction stops waiting for room when `stop` is requested; the recording does not.
  void SetStop(std::stop_token stop) { stop_ = std::move(stop); }

  void OnRig(const RigDescription& rig) {
    if (rig.session == session_) return;
    SessionStart start;
    start.rig = rig;
    start.folder = SessionFolder(options_, single_scan_, rig.session, clock_.Now());
    if (const Status prepared = PrepareOutputDir(start.folder); !prepared.ok()) {
      LOG(Ground, Error) << "this scan will have no results: " << prepared.message();
    }
    start.recording_promise = std::make_shared<std::promise<RecordingOutcome>>();
    start.recording = start.recording_promise->get_future().share();
    session_ = rig.session;
    Send(start);
    std::deque<Item> early = std::exchange(early_, {});
    for (Item& item : early) {
      if (SessionOf(item) == session_) Send(std::move(item));
    }
  }

  void OnFrame(Item item) {
    if (SessionOf(item) == session_) {
      Send(std::move(item));
      return;
    }
    constexpr std::size_t kMaxEarly = 128;
    if (early_.size() == kMaxEarly) {
      early_.pop_front();
      LOG(Ground, Warning)
          << "frames arrive but no rig description: is the edge of another version?";
    }
    early_.push_back(std::move(item));
  }

  void OnClock(const ClockAccount& clock) { recording_.Push(clock, {}); }
  void OnLate(Item item) { recording_.Push(std::move(item), {}); }
  void OnSessionEnd(const SessionAccount& account) {
    if (account.session == session_) Send(account);
  }

 private:
  static std::uint64_t SessionOf(const Item& item) {
    if (const auto* depth = std::get_if<ReceivedDepth>(&item)) return depth->frame->header.session;
    if (const auto* thermal = std::get_if<ReceivedThermal>(&item))
      return thermal->frame->header.session;
    if (const auto* sample = std::get_if<OutsidePoseSample>(&item)) return sample->session;
    return 0;
  }
  void Send(Item item) {
    if (auto* depth = std::get_if<ReceivedDepth>(&item)) depth->queued = clock_.Now();
    if (auto* thermal = std::get_if<ReceivedThermal>(&item)) thermal->queued = clock_.Now();
    recording_.Push(item, {});
    reconstruction_.Push(std::move(item), stop_);
  }

  const GroundOptions& options_;
  const bool single_scan_;
  const Clock& clock_;
  ItemQueue& reconstruction_;
  ItemQueue& recording_;
  std::stop_token stop_;
  std::optional<std::uint64_t> session_;
  std::deque<Item> early_;
};

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

}  // namespace

int RunGround(const GroundOptions& options, const ServiceMode& mode,
              const TransportEnvironment& environment, const Clock& clock, StopSignal& signal) {
  if (const Status prepared = PrepareOutputDir(options.live().output_dir()); !prepared.ok())
    return Fail(prepared);
  const Result<std::unique_ptr<Participant>> participant =
      Participant::Create(environment, options.live().domain());
  if (!participant) return Fail(participant.error());

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
  if (!recording.status().ok()) return ExitCode(recording.status());
  return ExitCode(reconstruction.status());
}

}  // namespace isotherm
