#include "ground/feedback/view_planner.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/units.h"

namespace isotherm {
namespace {

/// Pieces of lacking surface that candidates look at before the choice is renewed. A round of 48
/// with up to five views each, at three a message and ten messages a second, takes some eight
/// seconds. More: the choice is older than the model; fewer: the largest pieces are tried again and
/// again. Not tuned.
constexpr std::size_t kMaxTargets = 48;

/// Candidates look along the normal and from this far askew, to four sides: half of the good angles
/// of usual materials, so that a groove which hides from straight on is seen and the surface is
/// still good. Not tuned.
constexpr double kAskew_rad = 25.0 * kRadPerDeg;

/// Another view takes the place of the best one when it is worth this much more. Smaller: the
/// proposal jumps while the operator is on the way; larger: a poor first view is kept. Not tuned.
constexpr double kClearlyBetter = 1.2;

/// A view is worth its gain by the time that it takes: the way there at the pace of the thesis's
/// operator (chapter 7), then 1.2 s to notice it, to come to rest and to measure. The last is the
/// scripted operator's 0.4 s of reaction with half a second of stopping and some frames. Worth by
/// time, with what follows, took a guided scan of the door from 40 to 56 % measured well in 60 s.
constexpr double kWalk_m_s = 0.3;
constexpr double kWalk_rad_s = 17.0 * kRadPerDeg;
constexpr double kTakeView_s = 1.2;

/// Surface that may be where nobody looked yet counts for this multiple of surface that is known to
/// be lacking. Larger: the rig explores and leaves surface behind unmeasured; 0: it stays at what
/// it knows. Not tuned.
constexpr double kUnseenValue = 1.0;
/// Less unseen area is not looked for: one cell of SeenSpace (5 cm) is 0.0025 m2 and may be a
/// rounding at its border.
constexpr double kMinUnseen_m2 = 0.01;

/// A view from which tracking may slide is worth this fraction at least, so that the rig is sent
/// there when there is nothing else. Not tuned.
constexpr double kMinFirmness = 0.1;
/// From where it is tracked firmly the rig is not sent to a place that is less firm than this:
/// before the sill of the door, at less, the tracker went 0.6 m astray unnoticed and spoilt the
/// model (docs/experiments.md, guidance). Larger: half of the door is out of reach.
constexpr double kFirm = 0.05;
/// The way to a view is looked at here, as a fraction of it: one cast for the place that is
/// farthest from what both ends show.
constexpr double kOnTheWay = 0.5;
/// Every third round of candidates also tries what was found out of reach: there may be more
/// surface by now to be tracked by. Fewer rounds: time goes to what was tried before without gain;
/// more: surface stays out of reach that is not. Not tuned.
constexpr int kRoundsBetweenRetries = 3;

/// Views that are remembered while another one is proposed; the worst goes when one more comes.
/// More: older values, as the model changes. Not tuned.
constexpr std::size_t kMaxKept = 64;

/// Targets are looked at from this much more than the nearest depth that the depth camera measures,
/// since a hand sways and a surface is not flat. Smaller: parts of it have no return; larger: the
/// thermal image is coarser. Not tuned.
constexpr double kDepthReserve = 1.15;

/// A view counts as taken within this far of it, for this many steps (one a feedback message, ten a
/// second). A hand holds a rig within 2 to 4 mm and half a degree, but an operator stops when the
/// display says that they are there, which is coarser. Larger: views beside it are crossed out,
/// too; smaller: a view that gives nothing is proposed for ever.
constexpr double kAtView_m = 0.10;
constexpr double kAtView_rad = 15.0 * kRadPerDeg;
constexpr int kStepsAtView = 10;
/// A view is not proposed for longer than this many steps (a quarter of a minute) if nobody goes
/// there: there may be no way. A careful walk of 4 m fits into it.
constexpr int kStepsToView = 150;
/// Views that are not proposed again. More than a scan of an hour gives up; the oldest may be tried
/// again.
constexpr std::size_t kMaxExhausted = 512;

/// Between two steps the rig moved so little that what it sees counts as looked at: 0.055 m/s and 6
/// degrees/s at ten steps a second, a little more than the speed at which the raster of the
/// guidance experiment measures well (0.048 m/s). Larger: surface that motion smeared counts as not
/// measurable; smaller: a hand that sways never measures.
constexpr double kStill_m = 0.0055;
constexpr double kStill_rad = 0.6 * kRadPerDeg;

bool IsNear(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation() - b.translation()).norm() < kAtView_m &&
         std::acos(std::clamp(a.linear().col(2).dot(b.linear().col(2)), -1.0, 1.0)) < kAtView_rad;
}

/// Square metres per second.
double Worth(const NextView& view, const RigidTransform& T_map_depth) {
  return (view.gain_m2 + kUnseenValue * view.unseen_m2) * std::max(kMinFirmness, view.firmness) /
         (kTakeView_s + WalkTime(T_map_depth, view.T_map_depth));
}

}  // namespace

double WalkTime(const RigidTransform& from, const RigidTransform& to) {
  return std::max(TranslationDistance(from, to) / kWalk_m_s, RotationAngle(from, to) / kWalk_rad_s);
}

ViewPlanner::ViewPlanner(const FeedbackOptions& options, const ThermalOptions& limits,
                         const Rig& rig, float min_weight)
    : options_(options),
      assessor_(limits, rig, min_weight),
      angle_min_rad_(std::acos(assessor_.limits().cosine_min_angle)),
      angle_good_rad_(std::acos(assessor_.limits().cosine_good_angle)) {}

RigidTransform ViewPlanner::LookAt(const Eigen::Vector3d& target,
                                   const Eigen::Vector3d& towards_camera,
                                   const RigidTransform& T_map_depth) const {
  const ConditionLimits& limits = assessor_.limits();
  const double middle_m = 0.5 * (limits.distance_min_m + limits.distance_good_m);
  const double distance_m = std::clamp(kDepthReserve * assessor_.min_depth_m(), middle_m,
                                       std::max<double>(middle_m, limits.distance_good_m));
  const Eigen::Vector3d z = -towards_camera;
  // As the rig is held now: x stays as level as it is.
  Eigen::Vector3d x = T_map_depth.linear().col(1).cross(z);
  if (x.norm() < 0.1) x = T_map_depth.linear().col(0) - z.dot(T_map_depth.linear().col(0)) * z;
  if (x.norm() < 0.1) x = z.unitOrthogonal();
  x.normalize();
  RigidTransform T_map_thermal = RigidTransform::Identity();
  T_map_thermal.linear().col(0) = x;
  T_map_thermal.linear().col(1) = z.cross(x);
  T_map_thermal.linear().col(2) = z;
  T_map_thermal.translation() = target + distance_m * towards_camera;
  return T_map_thermal * assessor_.T_thermal_depth();
}

void ViewPlanner::MakeCandidates(const ModelCoverage& coverage, const RigidTransform& T_map_depth) {
  // Straight on, the operator may be reflected.
  const double straight_rad = angle_min_rad_ > 0.0 ? 0.5 * (angle_min_rad_ + angle_good_rad_) : 0.0;
  const double askew_rad = straight_rad > 0.0 ? straight_rad : kAskew_rad;
  // The slanted views of a piece look at it from four sides, since what hides it or is reflected in
  // it from one side need not from another.
  constexpr int kSides = 4;
  unseen_m2_ = std::exchange(unseen_in_round_m2_, 0.0);
  const bool retries = ++rounds_ % kRoundsBetweenRetries == 0;
  const std::vector<LackingSurface> targets =
      coverage.Lacking(kMaxTargets, [&](std::uint64_t cell, double area_m2) {
        return retries || !reach_.IsOutOfReach(cell, area_m2);
      });
  for (const LackingSurface& target : targets)
    reach_.Begin(target, straight_rad == 0.0 ? 1 + kSides : kSides);
  // All straight views first: they are the most likely, and cells see parts of each other.
  if (straight_rad == 0.0) {
    for (const LackingSurface& target : targets) {
      candidates_.push_back(
          {LookAt(target.position_map, target.normal_map, T_map_depth), target.cell});
    }
  }
  for (int side = 0; side < kSides; ++side) {
    for (const LackingSurface& target : targets) {
      const Eigen::Vector3d u = target.normal_map.unitOrthogonal();
      const double azimuth = 0.5 * std::numbers::pi * side;
      const Eigen::Vector3d tangent =
          std::cos(azimuth) * u + std::sin(azimuth) * target.normal_map.cross(u);
      const Eigen::Vector3d towards_camera =
          std::cos(askew_rad) * target.normal_map + std::sin(askew_rad) * tangent;
      candidates_.push_back(
          {LookAt(target.position_map, towards_camera, T_map_depth), target.cell});
    }
  }
}

double ViewPlanner::Gain(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                         const ThermalVolume& thermal, ThreadPool& pool) {
  return assessor_.LookFrom(T_map_depth, tsdf, thermal, pool).gain_m2;
}

double ViewPlanner::OutOfReach(const ModelCoverage& coverage) const {
  double sum_m2 = 0.0;
  coverage.ForEachPiece([&](std::uint64_t piece, double area_m2) {
    sum_m2 += reach_.IsOutOfReach(piece, area_m2)
                  ? area_m2
                  : std::min(area_m2, assessor_.tried().VainArea(piece));
  });
  return sum_m2;
}

void ViewPlanner::Exhaust(const RigidTransform& T_map_depth) {
  exhausted_.push_back(T_map_depth);
  if (exhausted_.size() > kMaxExhausted) exhausted_.pop_front();
}

bool ViewPlanner::IsExhausted(const RigidTransform& T_map_depth) const {
  return std::ranges::any_of(exhausted_,
                             [&](const RigidTransform& view) { return IsNear(view, T_map_depth); });
}

void ViewPlanner::GiveUpBest() {
  if (!best_) return;
  Exhaust(best_->T_map_depth);
  best_.reset();
}

void ViewPlanner::NotePose(const RigidTransform& T_map_depth) {
  if (!best_) return;
  ++steps_proposed_;
  steps_at_best_ = IsNear(best_->T_map_depth, T_map_depth) ? steps_at_best_ + 1 : 0;
  // What was not measured well from there by now will not be.
  if (steps_at_best_ >= kStepsAtView || steps_proposed_ >= kStepsToView) GiveUpBest();
}

void ViewPlanner::NoteWhatIsSeen(const Model& model) {
  const bool is_still = T_map_depth_before_ &&
                        TranslationDistance(*T_map_depth_before_, model.T_map_depth) < kStill_m &&
                        RotationAngle(*T_map_depth_before_, model.T_map_depth) < kStill_rad;
  T_map_depth_before_ = model.T_map_depth;
  if (is_still) assessor_.NoteLook(model.T_map_depth, model.tsdf, model.thermal, model.pool);
}

std::optional<NextView> ViewPlanner::Try(const RigidTransform& T_map_view, const Model& model) {
  const Outlook outlook = assessor_.LookFrom(T_map_view, model.tsdf, model.thermal, model.pool);
  if (outlook.gain_m2 < options_.expert().min_gain_m2() && outlook.unseen_m2 < kMinUnseen_m2)
    return std::nullopt;
  if (is_firm_here_ && outlook.firmness < kFirm) return std::nullopt;
  unseen_in_round_m2_ = std::max(unseen_in_round_m2_, outlook.unseen_m2);
  return NextView{T_map_view, outlook.gain_m2, outlook.unseen_m2, outlook.firmness};
}

bool ViewPlanner::HasWay(const RigidTransform& T_map_view, const Model& model) {
  // Near by, the view at the end says enough.
  if (IsNear(model.T_map_depth, T_map_view)) return true;
  const Outlook outlook = assessor_.LookFrom(Interpolate(model.T_map_depth, T_map_view, kOnTheWay),
                                             model.tsdf, model.thermal, model.pool);
  return outlook.is_possible && outlook.firmness >= kFirm;
}

void ViewPlanner::KeepForLater(const NextView& view, const RigidTransform& T_map_depth) {
  // Of views that are alike one is enough.
  std::erase_if(kept_,
                [&](const NextView& other) { return IsNear(other.T_map_depth, view.T_map_depth); });
  kept_.push_back(view);
  if (kept_.size() <= kMaxKept) return;
  kept_.erase(std::ranges::min_element(
      kept_, {}, [&](const NextView& other) { return Worth(other, T_map_depth); }));
}

void ViewPlanner::Offer(NextView view, const Model& model) {
  const RigidTransform& here = model.T_map_depth;
  const auto is_better = [&] {
    return !best_ || Worth(view, here) >= kClearlyBetter * Worth(*best_, here);
  };
  // The way costs another cast, so only views that would be proposed are asked for theirs. Without
  // a way the view is worth less, and may not be better any more.
  if (is_better() && !HasWay(view.T_map_depth, model)) view.firmness = 0.0;
  if (!is_better() || (is_firm_here_ && view.firmness < kFirm)) {
    KeepForLater(view, here);
    return;
  }
  if (best_) KeepForLater(*best_, here);
  best_ = view;
  steps_at_best_ = steps_proposed_ = 0;
}

void ViewPlanner::TryBestAgain(const Model& model) {
  const RigidTransform T_map_view = best_->T_map_depth;
  // The model has grown since: what the view would have measured may be measured now, from
  // elsewhere.
  best_ = Try(T_map_view, model);
  if (!best_ || HasWay(T_map_view, model)) return;
  best_->firmness = 0.0;
  if (is_firm_here_) best_.reset();
}

bool ViewPlanner::TryKept(const Model& model) {
  const auto most = std::ranges::max_element(
      kept_, {}, [&](const NextView& view) { return Worth(view, model.T_map_depth); });
  if (most == kept_.end()) return false;
  const NextView view = *most;
  if (best_ && Worth(view, model.T_map_depth) < kClearlyBetter * Worth(*best_, model.T_map_depth))
    return false;
  kept_.erase(most);
  if (IsExhausted(view.T_map_depth)) return true;
  const std::optional<NextView> again = Try(view.T_map_depth, model);
  if (again) Offer(*again, model);
  return true;
}

void ViewPlanner::TryNewCandidates(int count, const Model& model) {
  for (; count > 0 && !candidates_.empty(); candidates_.pop_front()) {
    const Candidate& candidate = candidates_.front();
    if (IsExhausted(candidate.T_map_depth)) {
      // A view that was given up says that its surface cannot be had from there.
      reach_.Note(candidate.cell, false);
      continue;
    }
    --count;
    const std::optional<NextView> view = Try(candidate.T_map_depth, model);
    reach_.Note(candidate.cell, view && view->gain_m2 >= options_.expert().min_gain_m2());
    if (view) Offer(*view, model);
  }
}

void ViewPlanner::Step(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                       const ModelCoverage& coverage, const RigidTransform& T_map_depth,
                       bool is_measuring, ThreadPool& pool) {
  if (options_.expert().views_per_message() == 0) return;
  const Model model{tsdf, thermal, T_map_depth, pool};
  // While tracking is lost or the shutter is closed, being at a view says nothing about it.
  if (is_measuring) {
    NotePose(T_map_depth);
    assessor_.NoteSeen(T_map_depth, tsdf.grid());
    NoteWhatIsSeen(model);
  }
  is_firm_here_ = assessor_.LookFrom(T_map_depth, tsdf, thermal, pool).firmness >= kFirm;
  int left = options_.expert().views_per_message();
  if (best_) {
    TryBestAgain(model);
    --left;
  }
  // At least one new candidate is tried in each step.
  for (; left > 1 && TryKept(model); --left) {
  }
  if (candidates_.empty()) MakeCandidates(coverage, T_map_depth);
  TryNewCandidates(left, model);
}

}  // namespace isotherm
