#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "common/codec/codec.h"
#include "common/concurrency/bounded_queue.h"
#include "common/concurrency/latest_value.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "common/time/step_watch.h"
#include "common/time/thread_progress.h"
#include "edge/backfill/backfill.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/nuc/nuc_control.h"
#include "edge/pipeline/camera_health.h"
#include "edge/pipeline/feedback_monitor.h"
#include "edge/publisher/publisher.h"
#include "edge/source/blind_detector.h"
#include "edge/source/frame_source.h"
#include "edge/spool/encoded_frame.h"
#include "edge/spool/spool.h"
#include "edge/timestamper/timestamper.h"

namespace isotherm {

class EdgeOptions;

/// Holds what the pipeline is put together from. All but the spool must outlive it.
struct EdgeParts {
  FrameSource& source;  ///< Opened; bad frames are already out (SupervisedSource).
  Publisher& publisher;
  FrameCounters& counters;
  CameraHealth& health;
  const Clock& clock;
  std::unique_ptr<Spool> spool;  ///< Null: no recording.
  std::uint64_t session = 0;
  /// The numbers of the first frames, by Sensor: higher for a session that goes on.
  std::array<std::uint64_t, 2> first_numbers{};
  double rig_thermal_delay_s = 0.0;
};

/// The straight line of the edge and its threads:
///
///   FrameSource -> Timestamper -> NucControl -> queue -> Codec -+-> queue -> Spool
///    (supervised)                 (thermal only)                +-> queue -> Publisher
///   |------------ capture thread -----------|  codec thread     spool and publish threads
///
///   recording -> Backfill -> Publisher   (backfill thread: what the ground lacks)
///
/// Frames are stamped while earlier ones are still being packed. Capture waits for neither disk nor
/// network: full queues drop the oldest frame and count it. Only unpaced playback (rate 0) waits,
/// because there is nothing to miss. A receive thread serves the ground's messages. Thread-bound to
/// the thread that starts and stops it, except where noted.
class EdgePipeline {
 public:
  EdgePipeline(const EdgeOptions& options, EdgeParts parts);
  ~EdgePipeline();

  /// Starts listening to the ground; frames flow from StartCapture on.
  void StartReceiving();
  void StartCapture();
  /// Ends capture, empties the queues, closes the recording, then ends the threads of the link.
  /// Returns the recording's first error, or ok. Idempotent.
  Status Stop();
  /// The first part of Stop. Returns false if the source did not end within `limit`. It is then
  /// left behind: the rest can be stopped all the same, but the pipeline cannot be destroyed before
  /// the source ends.
  bool StopCapture(Nanoseconds limit);
  /// The second part of Stop: writes what waits for the disk and closes the recording. Does not
  /// wait for the link, which is left to Stop.
  Status StopRecording();

  /// Describes the rig anew in the recording, if there is one. Thread-safe.
  void RecordRig(RigUpdate update);
  /// Answers what the ground has asked for since the last call, but for orders to start or stop a
  /// scan: whoever runs the scans takes these and answers them.
  void AnswerCommands();
  std::vector<Command> TakeScanOrders();
  void Answer(const CommandResult& result);

  /// Returns whether the source has ended. Thread-safe.
  bool source_ended() const { return source_ended_; }
  /// Returns true when the source has ended and each of its frames was recorded and published, or
  /// dropped and counted. Thread-safe.
  bool IsCaptured() const;
  /// Returns true when that is so, and the ground has what it can have of them. Thread-safe.
  bool finished() const;
  /// Returns how many recorded frames the ground lacks, as far as is known, and how many were sent
  /// to it from the recording. Thread-safe.
  std::uint64_t frames_lacking() const { return backfill_ ? backfill_->lacking() : 0; }
  /// Returns how many of them were deleted from the recording to keep the newest. Thread-safe.
  std::uint64_t frames_gone() const { return backfill_ ? backfill_->gone() : 0; }
  std::uint64_t frames_backfilled() const { return backfill_ ? backfill_->arrived() : 0; }
  /// Returns the state of the camera's correction as of the newest thermal frame. Thread-safe.
  NucReport nuc() const { return nuc_report_.Get().value_or(NucReport()); }
  /// Steps of the wall clock since the start and their sum, which capture times do not follow: the
  /// wall clock is ahead of them by this much. Thread-safe.
  std::uint64_t clock_steps() const { return clock_steps_; }
  Nanoseconds clock_step_total() const { return Nanoseconds(clock_step_total_ns_.load()); }
  /// Returns what the ground says. Thread-safe.
  const FeedbackMonitor& feedback() const { return feedback_; }
  /// Returns how full the queue to the disk is, 0..1; 0 without a recording. Thread-safe.
  double spool_fill_ratio() const;
  /// Returns the state of the recording; nullopt without one. Thread-safe.
  std::optional<SpoolStatus> recording() const;
  /// Returns the newest moments that the ground had marked, the newest last.
  const std::vector<ScanMark>& marks() const { return marks_; }
  /// Returns what a thread of the line is stuck in, in words; nullopt if all get on. Thread-safe.
  std::optional<std::string> StuckIn(SteadyTime now) const;

 private:
  /// A frame on its way to the codec.
  struct FrameToEncode {
    EncodedFrame encoded;  ///< Complete but for the image.
    Image<std::uint16_t> pixels;
  };

  void Capture(const std::stop_token& stop);
  Result<SourceItem> Read(const std::stop_token& stop);
  void Process(RawFrame raw, const std::stop_token& stop);
  /// Absorbs and reports steps of the wall clock.
  void WatchClock();
  CaptureTime TimeLineNow() const { return step_watch_.At(clock_.SteadyNow()); }
  /// Keeps the pose for the next frame to take along.
  void BufferOdometryPose(ExternalOdometry pose);
  void PublishExternalOdometry(const EncodedFrame& frame, const std::stop_token& stop);
  void ProcessDepth(RawFrame raw, const std::stop_token& stop);
  void ProcessThermal(RawFrame raw, const std::stop_token& stop);
  void QueueForCodec(FrameToEncode frame, const std::stop_token& stop);
  void Encode(const std::stop_token& stop);
  /// To the recording and to the link.
  void QueueForSinks(EncodedFrame encoded, const std::stop_token& stop);
  /// Notes how certain the stamp is, and how long it took from arrival to here.
  void NoteStamped(const RawFrame& raw, const Stamp& stamp);
  FrameHeader Header(const RawFrame& raw, const Stamp& stamp) const;
  void Record(const std::stop_token& stop);
  void RecordMessages();
  void Publish(const std::stop_token& stop);
  void RunBackfill(const std::stop_token& stop) { backfill_->Run(stop); }
  /// Runs on the capture thread, which alone talks to the camera.
  void ServeNucCommands();
  void Execute(const Command& command);
  /// Remembers the moment, in the recording, too. Returns what to answer.
  CommandResult Mark(const Command& command);

  FrameSource& source_;
  Publisher& publisher_;
  FrameCounters& counters_;
  CameraHealth& health_;
  const Clock& clock_;
  const std::unique_ptr<Spool> spool_;
  const std::uint64_t session_;
  const std::array<std::uint64_t, 2> first_numbers_;
  const bool thermal_is_counts_;  ///< The camera measures no temperatures.
  const bool is_paced_;           ///< Frames come in their time, whatever becomes of them.

  StepWatch step_watch_;  ///< Used by the capture thread only.
  std::atomic<std::uint64_t> clock_steps_{0};
  std::atomic<std::int64_t> clock_step_total_ns_{0};
  Timestamper depth_timestamper_;
  Timestamper thermal_timestamper_;
  NucControl nuc_;
  BlindDetector blind_detector_;
  DepthEncoder depth_encoder_;
  ThermalEncoder thermal_encoder_;

  std::vector<ExternalOdometrySample> external_odometry_;  ///< Since the last frame.
  std::uint64_t odometry_poses_captured_ = 0;
  std::uint64_t odometry_poses_published_ = 0;

  std::atomic<bool> source_ended_{false};
  std::atomic<std::int64_t> newest_capture_ns_{0};  ///< 0: no frame yet.
  LatestValue<NucReport> nuc_report_;
  const TimeBase time_base_;
  bool capture_stopped_ = false;
  bool capture_left_behind_ = false;
  bool recording_stopped_ = false;
  bool stopped_ = false;
  Status recording_status_;
  ThreadProgress reading_;
  ThreadProgress recording_;
  ThreadProgress publishing_;

  /// Holds feedback and when it came, by the edge's wall clock.
  struct ReceivedFeedback {
    Feedback feedback;
    CaptureTime arrival;
  };
  FeedbackMonitor feedback_;
  /// Feedback of several seconds, for the spool thread to take along with the frames.
  BoundedQueue<ReceivedFeedback> feedback_to_record_{64, OverflowPolicy::kDropOldest};
  BoundedQueue<RecordedLog> marks_to_record_{16, OverflowPolicy::kDropOldest};
  /// The rig with a camera that came late, for the spool thread, too.
  LatestValue<RigUpdate> rig_to_record_;
  BoundedQueue<CommandResult> nuc_answers_{64, OverflowPolicy::kDropOldest};
  // Commands that come faster than they can be executed are refused, the oldest first.
  const std::function<void(const Command&)> refuse_ = [this](const Command& command) {
    nuc_answers_.Push(
        {command.number, CommandOutcome::kRefused, "too many commands at once; send it again"}, {});
  };
  BoundedQueue<Command> commands_{16, OverflowPolicy::kDropOldest, refuse_};
  BoundedQueue<Command> nuc_commands_{16, OverflowPolicy::kDropOldest, refuse_};
  std::vector<Command> scan_orders_;
  std::vector<ScanMark> marks_;  ///< At most kMaxMarks.
  BoundedQueue<FrameToEncode> codec_queue_;
  const std::size_t spool_capacity_;
  BoundedQueue<EncodedFramePtr> spool_queue_;
  BoundedQueue<EncodedFramePtr> publish_queue_;
  std::unique_ptr<Backfill> backfill_;  ///< nullptr without a recording, and if it is turned off.
  std::jthread receive_thread_;
  std::jthread spool_thread_;
  std::jthread publish_thread_;
  std::jthread backfill_thread_;
  std::jthread codec_thread_;
  std::future<void> capture_ended_;
  std::jthread capture_thread_;
};

}  // namespace isotherm
