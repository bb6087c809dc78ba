#include "ground/experiment/true_conditions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotherm {
namespace {

using Eigen::Vector3d;

/// Returns whether something is in front of `p` by more than `tolerance_m`.
bool IsHidden(const Scene& scene, const Vector3d& viewer, const Vector3d& p, double tolerance_m) {
  const Vector3d to_point = p - viewer;
  const auto hit = scene.Intersect(viewer, to_point);
  return hit && (1.0 - hit->distance) * to_point.norm() > tolerance_m;
}

bool IsInImage(const CameraModel& camera, const RigidTransform& T_world_camera,
               const Vector3d& p_world, double margin_px) {
  const auto pixel = Project(camera, T_world_camera.inverse() * p_world);
  return pixel && pixel->x() >= margin_px && pixel->y() >= margin_px &&
         pixel->x() <= camera.width - 1 - margin_px && pixel->y() <= camera.height - 1 - margin_px;
}

double AngleDeg(const Vector3d& viewer, const SurfacePoint& point) {
  const double cosine = point.n_world.dot((viewer - point.p_world).normalized());
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// How many of the lines of sight to the point and to four places around it are hidden.
int CountHidden(const Scene& scene, const Vector3d& viewer, const SurfacePoint& point) {
  constexpr double kAround_m = 0.006;     // Some thermal pixels.
  constexpr double kTolerance_m = 0.015;  // A surface at 60 degrees comes this much nearer there.
  const Vector3d ray = (point.p_world - viewer).normalized();
  const Vector3d right = ray.unitOrthogonal(), down = ray.cross(right);
  int hidden = IsHidden(scene, viewer, point.p_world, 0.003) ? 1 : 0;
  for (const Vector3d& side : {right, Vector3d(-right), down, Vector3d(-down)})
    hidden += IsHidden(scene, viewer, point.p_world + kAround_m * side, kTolerance_m) ? 1 : 0;
  return hidden;
}

struct Shift {
  double distance_m, angle_deg;
  bool only_sure;
};

TrueClasses Classify(const TrueCondition& condition, const ThermalOptions& o, const Shift& shift) {
  const auto classify = [](double value, double low, double good, double high) {
    if (value < low || value > high) return ConditionClass::kBad;
    return value <= good ? ConditionClass::kGood : ConditionClass::kAcceptable;
  };
  const double angle_deg = std::abs(condition.angle_deg + shift.angle_deg);
  return {classify(condition.distance_m + shift.distance_m, o.distance().min_m(),
                   o.distance().good_m(), o.distance().max_m()),
          classify(angle_deg, o.angle().min_deg(), o.angle().good_deg(), o.angle().max_deg())};
}

/// Algorithm 6: the best of the valid conditions; the last one if none was valid.
std::optional<TrueClasses> Best(const std::vector<TrueCondition>& conditions,
                                const ThermalOptions& limits, const Shift& shift) {
  std::optional<TrueClasses> best, last;
  const auto rank = [](const TrueClasses& c) {  // kGood is 1, kAcceptable 2.
    return 4 * static_cast<int>(c.distance) + static_cast<int>(c.angle);
  };
  for (const TrueCondition& condition : conditions) {
    if (!(shift.only_sure ? condition.surely_seen : condition.maybe_seen)) continue;
    last = Classify(condition, limits, shift);
    const bool valid =
        last->distance != ConditionClass::kBad && last->angle != ConditionClass::kBad;
    if (valid && (!best || rank(*last) < rank(*best))) best = last;
  }
  return best ? best : last;
}

}  // namespace

std::vector<TrueCondition> TrueConditions(const SimulatedScan& scan,
                                          const std::vector<std::size_t>& frames,
                                          const SurfacePoint& point) {
  // Room for errors of pose and rectification: within it the truth is left open.
  constexpr double kMargin_px = 6.0;
  constexpr double kSteepForDepth_deg = 62.0;  // Returns become rare at 70.
  // A surface must have been seen a few times before the model has it.
  constexpr int kFramesUntilModelled = 3;
  std::vector<TrueCondition> conditions;
  int seen_in_a_row = 0;
  for (const std::size_t number : frames) {
    const CaptureTime time = scan.thermal_times()[number].exposure;
    const RigidTransform T_world_thermal = scan.ThermalPoseAt(time);
    const RigidTransform T_world_depth = scan.PoseAt(time);
    const Vector3d viewer = T_world_thermal.translation();
    TrueCondition& condition = conditions.emplace_back();
    condition.distance_m = (point.p_world - viewer).norm();
    condition.angle_deg = AngleDeg(viewer, point);
    if (condition.angle_deg > 90.0 + kMargin_px ||
        !IsInImage(*scan.rig().thermal, T_world_thermal, point.p_world, -kMargin_px)) {
      seen_in_a_row = 0;
      continue;
    }
    const int hidden = CountHidden(scan.scene(), viewer, point);
    condition.maybe_seen = hidden < 5;
    const bool seen = hidden == 0 &&
                      IsInImage(*scan.rig().thermal, T_world_thermal, point.p_world, kMargin_px) &&
                      IsInImage(*scan.rig().depth, T_world_depth, point.p_world, kMargin_px) &&
                      AngleDeg(T_world_depth.translation(), point) < kSteepForDepth_deg &&
                      CountHidden(scan.scene(), T_world_depth.translation(), point) == 0;
    seen_in_a_row = seen ? seen_in_a_row + 1 : 0;
    condition.surely_seen = seen_in_a_row >= kFramesUntilModelled;
  }
  return conditions;
}

std::optional<TrueClasses> ExpectClasses(const std::vector<TrueCondition>& conditions,
                                         const ThermalOptions& limits) {
  // By how much the model's surface and normals may be off: where the class would change with it,
  // none is expected.
  constexpr double kDistance_m = 0.01, kAngle_deg = 5.0;
  const auto expected = Best(conditions, limits, {0.0, 0.0, true});
  if (!expected) return std::nullopt;
  for (const double distance_m : {-kDistance_m, kDistance_m}) {
    for (const double angle_deg : {-kAngle_deg, kAngle_deg}) {
      for (const bool only_sure : {false, true}) {
        if (Best(conditions, limits, {distance_m, angle_deg, only_sure}) != expected)
          return std::nullopt;
      }
    }
  }
  return expected;
}

}  // namespace isotherm
