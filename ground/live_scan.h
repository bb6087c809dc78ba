#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <variant>

#include "common/base/stage_stats.h"
#include "common/base/status.h"
#include "common/time/clock.h"
#include "common/transport/messages.h"
#include "ground/assembler/assembler.h"
#include "ground/feedback/coverage.h"
#include "ground/ground_options.pb.h"
#include "ground/ground_pipeline.h"
#include "ground/subscriber/received_frame.h"

namespace isotherm {

/// Where the results of a session go.
std::filesystem::path SessionFolder(const GroundOptions& options, bool single_scan,
                                    std::uint64_t session, CaptureTime start);

/// One session of the live driver: the same stages as the inline one, fed by the link. Owns no
/// thread. Thread-bound to the reconstruction thread.
class LiveScan {
 public:
  /// `clock` must outlive the scan; it is only asked how long frames waited.
  static Result<std::unique_ptr<LiveScan>> Create(const Clock& clock, const GroundOptions& options,
                                                  const RigDescription& rig);

  void Add(const ReceivedDepth& depth);
  void Add(const ReceivedThermal& thermal);
  /// Processes what the assembler still holds back.
  void FinishFrames();

  /// Feedback on the newest depth frame if one is due (LiveOptions.feedback_hz, by capture time).
  std::optional<Feedback> TakeFeedback();

  /// From a frame's arrival to its turn: in queues, and for the other stream.
  const StageStats& waiting() const { return waiting_; }

  std::uint64_t session() const { return session_; }
  std::uint64_t out_of_order() const { return assembler_.refused_late(); }
  GroundPipeline& pipeline() { return *pipeline_; }
  const Rig& rig() const { return rig_; }

 private:
  LiveScan(const Clock& clock, const GroundOptions& options, const RigDescription& rig,
           std::unique_ptr<GroundPipeline> pipeline);
  void Process(const Assembler::Frame& frame);
  void NoteTurn(const void* frame);
  /// Leaves work out while frames wait too long in the queue (LiveOptions.max_wait_s).
  void KeepUp(Nanoseconds queued);
  Feedback MakeFeedback();

  const Clock& clock_;
  const GroundOptions options_;
  const std::uint64_t session_;
  const Rig rig_;
  const bool keeps_up_;
  std::unique_ptr<GroundPipeline> pipeline_;
  Assembler assembler_;
  ViewMaps view_;
  std::optional<DepthReport> newest_report_;
  FrameHeader newest_header_;
  bool feedback_waiting_ = false;
  std::optional<CaptureTime> next_feedback_;
  bool nuc_running_ = false;
  std::map<const void*, CaptureTime> arrivals_;  ///< Of frames in the assembler.
  StageStats waiting_;
  bool told_behind_ = false;
};

}  // namespace isotherm
