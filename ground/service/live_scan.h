#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <variant>

#include "common/base/processor_time.h"
#include "common/base/stage_stats.h"
#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "ground/assembler/assembler.h"
#include "ground/calibration/calibration_check.h"
#include "ground/console/console_feed.h"
#include "ground/feedback/feedback_maker.h"
#include "ground/feedback/feedback_pace.h"
#include "ground/json/json.h"
#include "ground/options/ground_options.pb.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/pipeline/load_shedding_history.h"
#include "ground/service/arrival_ages.h"
#include "ground/service/scan_board.h"
#include "ground/subscriber/received_frame.h"

namespace isotherm {

/// Says what became of frames that an earlier process had recorded of the scan.
struct RebuildReport {
  std::uint64_t frames = 0;    ///< Came into the model.
  std::uint64_t left_out = 0;  ///< Came over the link meanwhile, and are recorded only.
  double elapsed_s = 0.0;
  bool is_finished = false;  ///< All of them have come into the model.
};

/// One session of the live driver: the same stages as the inline one, fed by the link. Owns no
/// thread. Thread-compatible: the reconstruction thread's, then the results' from FinishFrames on.
class LiveScan {
 public:
  /// `clock` must outlive the scan; it is only asked how long frames waited.
  /// `feed` hears what the console shows, if there is one; it must outlive the frames.
  static Result<std::unique_ptr<LiveScan>> Create(const Clock& clock, const GroundOptions& options,
                                                  const RigDescription& rig,
                                                  ConsoleFeed* feed = nullptr);

  /// To be called on the reconstruction thread before the scan goes to another one.
  void LeaveConsole();

  void Add(const ReceivedDepth& depth);
  void Add(const ReceivedThermal& thermal);
  /// Poses are not held back. Frames wait for each other, so that a pose is there before its frame.
  void Add(const ExternalOdometrySample& sample);
  /// Takes what an earlier process has recorded of this scan; before all others, and nobody waits
  /// for it.
  void AddRecorded(const DepthFramePtr& depth);
  void AddRecorded(const ThermalFramePtr& thermal);
  void AddRecorded(const ExternalOdometry& pose) { pipeline_->ProcessExternalOdometry(pose); }
  /// Takes the newest that is known of the rig's clock.
  void SetClock(const SessionClock& clock) { arrival_ages_.SetClock(clock); }
  /// Says whether the rig leaves frames for later, because the link does not carry all.
  void SetLinkNarrow(bool is_narrow) { link_is_narrow_ = is_narrow; }
  void SetRebuild(const RebuildReport& report) { rebuild_ = report; }
  /// Poses up to here are no longer waited for.
  void SkipPosesTo(std::uint64_t next) { next_odometry_pose_ = skipped_odometry_poses_ = next; }
  /// To be called between what was recorded and what comes: nothing of before is told the rig.
  void EndRecorded() { static_cast<void>(pace_.Take()); }
  /// Processes what the assembler still holds back.
  void FinishFrames(const std::function<void(double fraction)>& progress = {});
  /// Says whether the thermal camera is still as it was calibrated, once the frames are
  /// finished (CHECK).
  CalibrationCheckReport CheckCalibration(const std::function<void()>& progress = {},
                                          const std::stop_token& stop = {});

  /// Returns feedback on the newest depth frame if a message is due (live.expert.feedback_hz, by
  /// capture time).
  std::optional<Feedback> TakeFeedback();
  /// Prepares the next message of feedback, a bounded part of the work each time; callers send
  /// first. Does nothing while frames wait.
  void ThinkAhead();
  /// Returns what this process has used since the scan began, results and check left out once
  /// the frames are finished. Two scans that overlap both count.
  ProcessorTimes processor_times() const;
  /// Coverage of the whole model as it goes into stats.json.
  Json DescribeFeedback() const;
  /// Returns what the console has cost, as it goes into stats.json; null without one.
  Json DescribeConsole() const;
  /// Returns when work was left out to keep up, as it goes into stats.json; null if it never could
  /// be.
  Json DescribeLoadShedding() const;
  /// Returns what came from an earlier process's recording, as it goes into stats.json; null if
  /// nothing did.
  Json DescribeRebuild() const;
  /// To be called while no frame waits: lets the console go on.
  void WhileIdle();
  /// Returns whether WhileIdle has something to do.
  bool has_more_to_show() const { return feed_ != nullptr && feed_->has_more(); }

  /// Returns how long frames waited from their arrival to their turn: in queues, and for the other
  /// stream.
  const StageStats& waiting() const { return waiting_; }
  /// Tells how long they took from capture to arrival.
  const ArrivalAges& arrival_ages() const { return arrival_ages_; }

  std::uint64_t session() const { return session_; }
  /// Returns the console's number of this scan; 0 without one.
  std::uint64_t shown_scan() const { return shown_scan_; }
  /// The model's surface by how well it was measured.
  SurfaceAreas areas() const { return feedback_.areas(); }
  /// Returns what was left out to keep up.
  BehindCounts behind() const;
  std::uint64_t out_of_order() const { return assembler_.refused_late(); }
  std::uint64_t odometry_poses_received() const { return odometry_poses_received_; }
  /// Numbers below the highest received that did not come.
  std::uint64_t odometry_poses_missing() const {
    const std::uint64_t waited_for = next_odometry_pose_ - skipped_odometry_poses_;
    return waited_for - std::min(waited_for, odometry_poses_received_);
  }
  /// Returns what all frames so far have given.
  ScanModel model() const { return pipeline_->model(); }
  const Rig& rig() const { return rig_; }

 private:
  LiveScan(const Clock& clock, const GroundOptions& options, const RigDescription& rig,
           std::unique_ptr<GroundPipeline> pipeline, ConsoleFeed* feed);
  void Process(const Assembler::Frame& frame);
  /// Hands on what the assembler has put in order of recorded frames.
  void ProcessRecorded();
  void NoteQueueTime(const void* frame);
  /// Leaves work out while frames wait too long in the queue (live.expert.max_wait_s).
  void KeepUp(CaptureTime queued_at);
  void LogWhenDone();

  const Clock& clock_;
  const GroundOptions options_;
  const std::uint64_t session_;
  const Rig rig_;
  const bool keeps_up_;
  std::unique_ptr<GroundPipeline> pipeline_;
  ConsoleFeed* feed_;  ///< nullptr without a console, and after LeaveConsole.
  Assembler assembler_;
  CalibrationCheck calibration_check_;
  FeedbackMaker feedback_;
  FeedbackPace pace_;
  bool is_behind_ = false;
  bool link_is_narrow_ = false;
  bool is_recorded_ = false;  ///< A frame that is processed is not of now.
  bool reported_done_ = false;
  std::uint64_t odometry_poses_received_ = 0;
  std::uint64_t next_odometry_pose_ = 0;
  std::uint64_t skipped_odometry_poses_ = 0;     ///< Lower ones were recorded before.
  std::map<const void*, CaptureTime> arrivals_;  ///< When the frames in the assembler arrived.
  StageStats waiting_;
  ArrivalAges arrival_ages_;
  StageStats making_, thinking_;  ///< Feedback, and what is prepared after it.
  bool reported_behind_ = false;
  const CaptureTime begun_ = clock_.Now();  ///< Frames that came before waited for the scan itself.
  const SteadyTime steady_begun_ = clock_.SteadyNow();
  LoadSheddingHistory load_shedding_;
  std::optional<RebuildReport> rebuild_;
  std::uint64_t shown_scan_ = 0;
  std::optional<ConsoleCost> console_cost_;  ///< After LeaveConsole.
  const ProcessorTimes processor_before_ = ReadProcessorTimes();
  std::optional<ProcessorTimes> processor_after_;  ///< Since the frames are finished.
};

}  // namespace isotherm
