#include "ground/feedback/feedback_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ground/feedback/confidence_image.h"
#include "ground/feedback/view_smear.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// Coverage of the view is assessed by this many pixels per row at least, whatever the image's
/// size, so that its fractions mean the same without an image. More: more time per message; fewer:
/// a fraction jumps by more than the 0.01 % that one of them is. Not tuned.
constexpr int kMinColumns = 160;

/// The rig is on the way to the next view while it comes nearer at this fraction of a scan's pace,
/// and for kTurnRound_s after it did: to come to rest, or to turn round when it is sent elsewhere.
/// Meanwhile smear is no reason to say "slower". Smaller: who strays slowly counts as on the way;
/// larger: who goes there slowly is told to go slower still. Not measured by itself.
constexpr double kMinPace = 0.25;
constexpr double kTurnRound_s = 0.6;
/// Nearer than this, in seconds at that pace (7 cm, 4 degrees), the rig is there. Not tuned.
constexpr double kThere_s = 0.25;

/// Once parts of the model are on the disk, only blocks within this distance of the rig are
/// counted: of those hardly any was out of view for so long that it is on the disk. Larger:
/// counting reads from the disk.
constexpr double kResidentReach_m = 1.0;

/// The image's size while the link does not carry all frames: at ten messages a second a hundredth
/// of 8 Mbit/s. Larger: finer, at the cost of frames. Not tuned.
constexpr std::size_t kNarrowConfidenceImageBytes = 1'000;

std::vector<Advice> ToWire(AdviceKind kind) {
  switch (kind) {
    case AdviceKind::kGoBack:
      return {Advice::kGoBackToRelocalise};
    case AdviceKind::kHoldForNuc:
      return {Advice::kHoldForNuc};
    case AdviceKind::kDone:
      return {Advice::kDone};
    case AdviceKind::kSlower:
      return {Advice::kSlower};
    case AdviceKind::kCloser:
      return {Advice::kMoveCloser};
    case AdviceKind::kFarther:
      return {Advice::kMoveFarther};
    case AdviceKind::kLessOblique:
      return {Advice::kLessOblique};
    case AdviceKind::kMoreOblique:
      return {Advice::kMoreOblique};
    case AdviceKind::kNone:
      break;
  }
  return {};
}

CoverageFractions ToFractions(const CoverageSummary& view) {
  if (view.surface == 0.0) return {};
  return {static_cast<float>(view.good), static_cast<float>(view.acceptable),
          static_cast<float>(view.bad), static_cast<float>(view.never_measured)};
}

CoverageFractions ToFractions(const SurfaceAreas& areas) {
  const double total = areas.total_m2();
  if (!(total > 0.0)) return {};
  const auto fraction = [total](double area) {
    return static_cast<float>(std::clamp(area / total, 0.0, 1.0));
  };
  return {fraction(areas.good_m2), fraction(areas.acceptable_m2), fraction(areas.bad_m2),
          fraction(areas.never_m2)};
}

TrackingState StateOf(const DepthReport& report) {
  if (!report.tracked) return TrackingState::kLost;
  return report.tracking.quality() == TrackingQuality::kDegraded ? TrackingState::kDegraded
                                                                 : TrackingState::kTracked;
}

/// Every `stride`th pixel of each row and column.
void Thin(const SurfaceMaps& maps, int stride, SurfaceMaps& thin) {
  thin.Resize(maps.width() / stride, maps.height() / stride);
  const auto copy = [&](const Image<float>& from, Image<float>& to) {
    for (int y = 0; y < to.height(); ++y) {
      for (int x = 0; x < to.width(); ++x) to.At(x, y) = from.At(stride * x, stride * y);
    }
  };
  copy(maps.vx, thin.vx);
  copy(maps.vy, thin.vy);
  copy(maps.vz, thin.vz);
  copy(maps.nx, thin.nx);
  copy(maps.ny, thin.ny);
  copy(maps.nz, thin.nz);
}

/// A pose of which only the place counts, in `world`; nullopt while its sub-map is not joined.
std::optional<RigidTransform> InWorld(const Atlas& atlas, int map,
                                      const RigidTransform& T_map_depth) {
  const std::optional<WorldPose> pose = atlas.ToWorld({.map = map, .T_map_depth = T_map_depth});
  if (!pose) return std::nullopt;
  return pose->T_world_depth;
}

/// Returns where tracking worked, in `world`, for a rig that is lost, or slides, since
/// `known_until` and for so long; nullopt if that is not known. It is the last pose at first; who
/// was not found there is sent back along the way they came.
std::optional<RigidTransform> LastKnownPose(const ScanModel& scan, CaptureTime known_until,
                                            Nanoseconds lost_for) {
  // Most losses end at the last pose within this time (a hand before the camera, a swing back).
  // Then the way back is shown as fast as it was gone.
  constexpr Nanoseconds kStay = std::chrono::seconds(2);
  const std::vector<StampedPose>& poses = scan.trajectory.poses();
  if (!poses.empty()) {
    const Nanoseconds back = std::max(Nanoseconds(0), lost_for - kStay);
    auto pose = std::ranges::lower_bound(poses, std::min(poses.back().time, known_until) - back, {},
                                         &StampedPose::time);
    return pose->T_world_depth;
  }
  const Atlas& atlas = scan.atlas;
  const std::vector<RigidTransform>& known = atlas.active().relocaliser->keyframes().poses();
  if (known.empty()) return std::nullopt;
  return InWorld(atlas, atlas.active_index(), known.back());
}

}  // namespace

FeedbackMaker::FeedbackMaker(const GroundOptions& options, const RigDescription& rig)
    : options_(options),
      rig_(rig.rig),
      session_(rig.session),
      T_depth_thermal_(rig.rig.T_thermal_depth ? rig.rig.T_thermal_depth->inverse()
                                               : RigidTransform::Identity()),
      limits_(CompleteLimits(options.thermal(), rig.rig.thermal_sensor)),
      adviser_(options.feedback(), limits_),
      coverage_(static_cast<float>(options.export_().expert().min_weight())) {}

ViewPlanner* FeedbackMaker::Planner(const ScanModel& scan) {
  if (!rig_.depth || !rig_.thermal || !rig_.T_thermal_depth) return nullptr;
  return &planners_
              .try_emplace(scan.atlas.active_index(), options_.feedback(), options_.thermal(), rig_,
                           static_cast<float>(options_.raycast().expert().min_weight()))
              .first->second;
}

double FeedbackMaker::OutOfReach() const {
  double sum_m2 = 0.0;
  coverage_.ForEachThatCounts([&](int map, const ModelCoverage& coverage) {
    const auto planner = planners_.find(map);
    if (planner != planners_.end()) sum_m2 += planner->second.OutOfReach(coverage);
  });
  return sum_m2;
}

double FeedbackMaker::Unseen() const {
  double max_m2 = 0.0;
  coverage_.ForEachThatCounts([&](int map, const ModelCoverage&) {
    const auto planner = planners_.find(map);
    if (planner != planners_.end()) max_m2 = std::max(max_m2, planner->second.Unseen());
  });
  return max_m2;
}

CoverageSummary FeedbackMaker::LookAtView(const ScanModel& scan) {
  const ModelView& model = scan.view;
  view_.Resize(0, 0);
  if (model.maps.width() == 0) return {};
  const int columns = std::max(kMinColumns, options_.feedback().expert().image_width_px());
  Thin(model.maps, std::max(1, model.maps.width() / columns), maps_);
  // Distances and angles are limits of the thermal camera.
  SampleView(maps_, (model.T_map_depth * T_depth_thermal_).translation(), scan.tsdf(),
             scan.thermal(), scan.pool, view_);
  return SummarizeCoverage(view_, Smear(scan), limits_);
}

Image<float> FeedbackMaker::Smear(const ScanModel& scan) const {
  const std::optional<StampedMapPose> before = scan.motion.before_last();
  const std::optional<StampedMapPose> now = scan.motion.last();
  if (!rig_.thermal || !before || !now) return {};
  const RigidTransform T_map_thermal = now->T_map_depth * T_depth_thermal_;
  const CameraMotion motion = MotionBetween(before->T_map_depth * T_depth_thermal_, T_map_thermal,
                                            ToSeconds(now->time - before->time));
  return SmearInView(maps_, T_map_thermal, motion, *rig_.thermal, rig_.thermal_sensor);
}

void FeedbackMaker::NoteWay(const FeedbackMoment& moment, const ScanModel& scan) {
  const CaptureTime now = moment.header.capture_time;
  const auto planner = planners_.find(scan.atlas.active_index());
  if (!moment.report.tracked || moment.report.slides) {
    // The rig was lost at the view or on the way to it, so the view is to blame; elsewhere it is
    // not.
    const bool is_there = way_s_ && *way_s_ <= kThere_s;
    if ((is_on_the_way_ || is_there) && planner != planners_.end()) planner->second.GiveUpBest();
    is_on_the_way_ = false;
    way_s_ = {};
    on_the_way_until_ = {};
    return;
  }
  const bool has_view = planner != planners_.end() && planner->second.best();
  const std::optional<double> before_s = std::exchange(way_s_, {});
  if (has_view)
    way_s_ = WalkTime(moment.report.pose.T_map_depth, planner->second.best()->T_map_depth);
  if (before_s && way_s_ && way_noted_at_ &&
      *before_s - *way_s_ >= kMinPace * ToSeconds(now - *way_noted_at_)) {
    on_the_way_until_ = now + FromSeconds(kTurnRound_s);
  }
  way_noted_at_ = now;
  is_on_the_way_ = way_s_ && on_the_way_until_ && now < *on_the_way_until_;
}

ScanSituation FeedbackMaker::Situation(const FeedbackMoment& moment) const {
  ScanSituation situation;
  situation.tracking_lost = !moment.report.tracked;
  situation.slides = moment.report.slides;
  situation.nuc_running = moment.nuc_running;
  situation.is_on_the_way = is_on_the_way_;
  situation.ground_is_behind = moment.ground_is_behind;
  situation.speed_m_s = moment.speed_m_s;
  situation.rotation_rate_deg_s = moment.rotation_rate_deg_s;
  if (moment.frame_interval_s > 0.0) {
    situation.max_speed_m_s = options_.tsdf().expert().max_step_m() / moment.frame_interval_s;
    situation.max_rotation_rate_deg_s =
        options_.tsdf().expert().max_step_deg() / moment.frame_interval_s;
  }
  const SurfaceAreas all = areas();
  if (!coverage_.complete() || !(all.total_m2() > 0.0)) return situation;
  situation.out_of_reach_m2 = std::min(OutOfReach(), all.total_m2() - all.good_m2);
  // What may be beyond the ends of the known surface is not measured well yet.
  const double within_reach_m2 = all.total_m2() - situation.out_of_reach_m2 + Unseen();
  if (within_reach_m2 > 0.0) situation.model_good = all.good_m2 / within_reach_m2;
  return situation;
}

void FeedbackMaker::AddNextPose(const DepthReport& report, const ScanModel& scan,
                                Feedback& feedback) const {
  if (!report.tracked || report.slides) {
    feedback.T_world_depth_next =
        LastKnownPose(scan, last_known_, feedback.capture_time - last_known_);
    return;
  }
  const auto planner = planners_.find(report.pose.map);
  if (feedback.done || planner == planners_.end()) return;
  const std::optional<NextView>& best = planner->second.best();
  if (!best) return;
  feedback.T_world_depth_next = InWorld(scan.atlas, report.pose.map, best->T_map_depth);
  feedback.next_gain_m2 = best->gain_m2;
  feedback.T_depth_next = report.pose.T_map_depth.inverse() * best->T_map_depth;
}

Feedback FeedbackMaker::Make(const FeedbackMoment& moment, const ScanModel& scan) {
  ++messages_;
  Feedback feedback;
  feedback.session = session_;
  feedback.frame_number = moment.header.frame_number;
  feedback.capture_time = moment.header.capture_time;
  feedback.tracking_state = StateOf(moment.report);
  // A rig that was never tracked is lost from its first frame on.
  if ((moment.report.tracked && !moment.report.slides) || messages_ == 1)
    last_known_ = moment.header.capture_time;
  if (const auto pose =
          moment.report.tracked ? scan.atlas.ToWorld(moment.report.pose) : std::nullopt) {
    feedback.T_world_depth = pose->T_world_depth;
    feedback.pose_covariance = pose->covariance;
  }
  NoteWay(moment, scan);
  const CoverageSummary view = LookAtView(scan);
  feedback.view = ToFractions(view);
  feedback.model = ToFractions(areas());
  feedback.covered_area_m2 = std::max(0.0, areas().total_m2());
  OperatorAdvice advice = adviser_.Update(moment.header.capture_time, view, Situation(moment));
  feedback.advice = ToWire(advice.kind);
  feedback.advice_reason = std::move(advice.reason);
  feedback.done = adviser_.done();
  is_measuring_ =
      moment.report.tracked && !moment.report.slides && !moment.nuc_running && !feedback.done;
  AddNextPose(moment.report, scan, feedback);
  if (options_.feedback().expert().image_width_px() > 0 && view_.width() > 0) {
    feedback.image = EncodeWithin(
        DrawConfidence(view_, feedback.tracking_state == TrackingState::kLost),
        moment.link_is_narrow ? kNarrowConfidenceImageBytes : kMaxConfidenceImageBytes);
  }
  return feedback;
}

void FeedbackMaker::NoteViewElsewhere(const Atlas& atlas, ViewPlanner& planner) {
  if (!atlas.active().joined) return;
  auto& [map, view] = next_view_elsewhere_;
  if (map >= atlas.size()) map = 0;
  const std::vector<RigidTransform>& views = atlas.map(map).relocaliser->keyframes().poses();
  if (map == atlas.active_index() || !atlas.map(map).joined || view >= views.size()) {
    ++map;
    view = 0;
    return;
  }
  planner.NoteSeen(atlas.active().T_world_map.inverse() * atlas.map(map).T_world_map * views[view],
                   atlas.active().tsdf->grid());
  ++view;
}

void FeedbackMaker::ThinkAhead(const ScanModel& scan) {
  const VoxelGrid& grid = scan.tsdf().grid();
  const Eigen::Vector3d rig_vox = grid.ToVoxel(scan.view.T_map_depth.translation());
  const double reach_vox = kResidentReach_m / grid.voxel_size_m;
  const bool spills = !options_.volume().spill_dir().empty();
  const bool has_spilled = scan.spiller.spilled() > 0;
  // Looking at blocks that are on the disk would bring them back: those near the rig hardly are,
  // and of sub-maps that the rig has left all may be.
  const auto is_spilled = [&](const TsdfVolume& tsdf, std::int32_t block) {
    if (&tsdf != &scan.tsdf()) return spills;
    if (!has_spilled) return false;
    const GridIndex first = tsdf.block_coordinates(block) * kBlockSide;
    return (first.cast<double>() - rig_vox).norm() > reach_vox;
  };
  coverage_.Update(scan.atlas, is_spilled, options_.feedback().expert().blocks_per_message(),
                   scan.pool);
  ViewPlanner* planner = Planner(scan);
  if (planner == nullptr || scan.view.maps.width() == 0 || adviser_.done()) return;
  NoteViewElsewhere(scan.atlas, *planner);
  planner->Step(scan.tsdf(), scan.thermal(), *coverage_.Find(scan.atlas.active_index()),
                scan.view.T_map_depth, is_measuring_, scan.pool);
}

}  // namespace isotherm
