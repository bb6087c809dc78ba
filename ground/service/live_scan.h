#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
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
#include "ground/service/scan_board.h"
#include "ground/subscriber/received_frame.h"

namespace isotherm {

/// Returns where the results of a session go.
std::filesystem::path SessionFolder(const GroundOptions& options, bool single_scan,
                                    std::uint64_t session, CaptureTime start);

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
  /// To be called while no frame waits: lets the console go on.
  void WhileIdle();
  /// Returns whether WhileIdle has something to do.
  bool has_more_to_show() const { return feed_ != nullptr && feed_->has_more(); }

  /// Returns how long frames waited from their arrival to their turn: in queues, and for the other
  /// stream.
  const StageStats& waiting() const { return waiting_; }

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
    return next_odometry_pose_ - std::min(next_odometry_pose_, odometry_poses_received_);
  }
  /// Returns what all frames so far have given.
  ScanModel model() const { return pipeline_->model(); }
  const Rig& rig() const { return rig_; }

 private:
  LiveScan(const Clock& clock, const GroundOptions& options, const RigDescription& rig,
           std::unique_ptr<GroundPipeline> pipeline, ConsoleFeed* feed);
  void Process(const Assembler::Frame& frame);
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
  bool reported_done_ = false;
  std::uint64_t odometry_poses_received_ = 0;
  std::uint64_t next_odometry_pose_ = 0;
  std::map<const void*, CaptureTime> arrivals_;  ///< When the frames in the assembler arrived.
  StageStats waiting_;
  StageStats making_, thinking_;  ///< Feedback, and what is prepared after it.
  bool reported_behind_ = false;
  const CaptureTime begun_ = clock_.Now();  ///< Frames that came before waited for the scan itself.
  const SteadyTime steady_begun_ = clock_.SteadyNow();
  LoadSheddingHistory load_shedding_;
  std::uint64_t shown_scan_ = 0;
  std::optional<ConsoleCost> console_cost_;  ///< After LeaveConsole.
  const ProcessorTimes processor_before_ = ReadProcessorTimes();
  std::optional<ProcessorTimes> processor_after_;  ///< Since the frames are finished.
};

}  // namespace isotherm
