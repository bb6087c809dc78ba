#pragma once

#include <cstdint>
#include <string>

#include "common/base/stage_stats.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "ground/console/console_inbox.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/depth_report.h"
#include "ground/scan/scan_model.h"
#include "ground/snapshot/model_copier.h"

namespace isotherm {

/// Holds what the console has cost the reconstruction.
struct ConsoleCost {
  StageStats copying;  ///< The time that depth frames waited for the copying.
  std::uint64_t copied_blocks = 0;
  int max_viewers = 0;
};

/// The reconstruction's end of the console: copies what has changed in the model, for a bounded
/// time after each depth frame and only while somebody looks. Thread-bound to the reconstruction
/// thread.
class ConsoleFeed {
 public:
  /// `clock` and `inbox` must outlive it.
  ConsoleFeed(const GroundOptions& options, const Clock& clock, ConsoleInbox& inbox)
      : options_(options), clock_(clock), inbox_(inbox), copier_(clock) {}

  /// A scan begins; `name` is for people.
  void BeginScan(const RigDescription& rig, const std::string& name, const std::string& folder);
  void Show(DepthFramePtr frame) { inbox_.SetDepth(std::move(frame)); }
  void Show(ThermalFramePtr frame) { inbox_.SetThermal(std::move(frame)); }
  /// To be called after each depth frame.
  void AfterDepth(const FrameHeader& header, const DepthReport& report, const ScanModel& scan);
  /// To be called while no frames come: goes on with what is left to be copied.
  void WhileIdle(const ScanModel& scan);
  void Add(const Feedback& feedback) { inbox_.Add(feedback); }

  /// Returns whether WhileIdle has something to do.
  bool has_more() const { return inbox_.is_behind && inbox_.IsWatched(clock_.SteadyNow()); }
  std::uint64_t scan() const { return scan_; }
  /// Returns the cost of this scan so far.
  const ConsoleCost& cost() const { return cost_; }

 private:
  void CopyModel(const ScanModel& scan, Nanoseconds time);

  const GroundOptions options_;
  const Clock& clock_;
  ConsoleInbox& inbox_;
  ModelCopier copier_;
  std::uint64_t scan_ = 0;
  CaptureTime newest_{};  ///< The newest depth frame's.
  ConsoleCost cost_;
};

/// Returns what the page is told about a scan.
live::Scan DescribeScan(const GroundOptions& options, const RigDescription& rig,
                        const std::string& name, const std::string& folder);

}  // namespace isotherm
