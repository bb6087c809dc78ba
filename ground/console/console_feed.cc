#include "ground/console/console_feed.h"

#include <algorithm>

#include "ground/console/live_convert.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// Once parts of the model are on the disk, only blocks within this distance of the rig are copied
/// while frames come: they are in memory.
constexpr double kConsoleReach_m = 1.0;

TrackingState StateOfFrame(const DepthReport& report) {
  if (!report.tracked) return TrackingState::kLost;
  return report.tracking.quality() == TrackingQuality::kDegraded ? TrackingState::kDegraded
                                                                 : TrackingState::kTracked;
}

}  // namespace

void ConsoleFeed::BeginScan(const RigDescription& rig, const std::string& name,
                            const std::string& folder) {
  cost_ = {};
  copier_.Begin(++scan_);
  inbox_.Add(ScanBegun{.scan = scan_,
                       .description = DescribeScan(options_, rig, name, folder),
                       .folder = folder,
                       .measuring = MakeMeasuringOptions(options_, rig.rig.thermal_sensor)});
}

void ConsoleFeed::AfterDepth(const FrameHeader& header, const DepthReport& report,
                             const ScanModel& scan) {
  if (report.repeated) return;
  inbox_.is_behind = true;
  newest_ = header.capture_time;
  const SteadyTime start = clock_.SteadyNow();
  inbox_.Add(
      FramePose{.scan = scan_,
                .frame_number = header.frame_number,
                .capture_time = header.capture_time,
                .map = report.tracked ? report.pose.map : scan.atlas.active_index(),
                .T_map_depth = report.tracked ? report.pose.T_map_depth : scan.view.T_map_depth,
                .tracking = StateOfFrame(report)});
  const int viewers = inbox_.viewers;
  cost_.max_viewers = std::max(cost_.max_viewers, viewers);
  if (inbox_.IsWatched(start))
    CopyModel(scan, FromSeconds(1e-3 * options_.console().expert().copy_ms()));
  constexpr double kMillisecondsPerSecond = 1e3;
  cost_.copying.Add(kMillisecondsPerSecond * ToSeconds(clock_.SteadyNow() - start));
}

void ConsoleFeed::WhileIdle(const ScanModel& scan) {
  constexpr Nanoseconds kWhileIdle = std::chrono::milliseconds(10);
  CopyModel(scan, kWhileIdle);
}

void ConsoleFeed::CopyModel(const ScanModel& scan, Nanoseconds time) {
  std::unique_ptr<BlockBatch> batch = inbox_.TakeEmpty();
  if (!batch) return;
  CopyBudget budget{.time = time};
  if (scan.spiller.spilled() > 0) budget.reach_m = kConsoleReach_m;
  batch->capture_time = newest_;
  const bool any = copier_.Copy(scan.atlas, scan.view.T_map_depth, budget, *batch);
  if (!any) inbox_.is_behind = false;
  cost_.copied_blocks += batch->blocks.size();
  inbox_.GiveBack(std::move(batch), any);
}

live::Scan DescribeScan(const GroundOptions& options, const RigDescription& rig,
                        const std::string& name, const std::string& folder) {
  live::Scan scan;
  scan.set_phase(live::Scan::RUNNING);
  scan.set_name(name);
  scan.set_folder(folder);
  scan.set_rig(rig.rig.serial);
  if (rig.rig.depth) *scan.mutable_depth() = ToMessage(*rig.rig.depth);
  if (rig.rig.thermal) *scan.mutable_thermal() = ToMessage(*rig.rig.thermal);
  if (rig.rig.T_thermal_depth)
    *scan.mutable_t_thermal_depth() = ToMessage(*rig.rig.T_thermal_depth);
  const ThermalOptions limits = CompleteLimits(options.thermal(), rig.rig.thermal_sensor);
  live::Limits& shown = *scan.mutable_limits();
  shown.set_distance_min_m(limits.distance().min_m());
  shown.set_distance_good_m(limits.distance().good_m());
  shown.set_distance_max_m(limits.distance().max_m());
  shown.set_angle_min_deg(limits.angle().min_deg());
  shown.set_angle_good_deg(limits.angle().good_deg());
  shown.set_angle_max_deg(limits.angle().max_deg());
  shown.set_material(limits.material());
  return scan;
}

}  // namespace isotherm
