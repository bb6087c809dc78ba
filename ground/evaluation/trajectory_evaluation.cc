#include "ground/evaluation/trajectory_evaluation.h"

#include <fmt/format.h>

#include <algorithm>

#include "ground/evaluation/rigid_alignment.h"

namespace isotherm {
namespace {

struct Match {
  RigidTransform estimated;
  RigidTransform truth;
};

// The element of `sorted` nearest to `time` within `tolerance`, or sorted.size().
template <typename T, typename TimeOf>
std::size_t NearestInTime(std::span<const T> sorted, CaptureTime time, Nanoseconds tolerance,
                          const TimeOf& time_of) {
  const auto after =
      std::lower_bound(sorted.begin(), sorted.end(), time,
                       [&](const T& item, CaptureTime t) { return time_of(item) < t; });
  std::size_t best = sorted.size();
  Nanoseconds best_distance = tolerance;
  const std::size_t i = static_cast<std::size_t>(after - sorted.begin());
  for (const std::size_t candidate : {i, i - 1}) {  // i - 1 wraps to a huge number at the start.
    if (candidate >= sorted.size()) continue;
    const Nanoseconds distance = std::chrono::abs(time_of(sorted[candidate]) - time);
    if (distance <= best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

bool IsLeftOut(CaptureTime time, const TrajectoryEvaluationOptions& options) {
  const std::span<const CaptureTime> stamps(options.left_out);
  return NearestInTime(stamps, time, options.tolerance, [](CaptureTime t) { return t; }) <
         stamps.size();
}

std::vector<Match> Associate(std::span<const StampedPose> estimated,
                             std::span<const StampedPose> truth,
                             const TrajectoryEvaluationOptions& options, TrajectoryErrors& errors) {
  const auto time_of = [](const StampedPose& pose) { return pose.time; };
  std::vector<Match> matches;
  std::vector<bool> used(estimated.size(), false);
  for (const StampedPose& pose : truth) {
    if (IsLeftOut(pose.time, options)) {
      ++errors.left_out;
      continue;
    }
    ++errors.truth_poses;
    const std::size_t i = NearestInTime(estimated, pose.time, options.tolerance, time_of);
    // A pose counts once: two truths within the tolerance must not both match it.
    if (i == estimated.size() || used[i]) continue;
    used[i] = true;
    matches.push_back({estimated[i].T_world_depth, pose.T_world_depth});
  }
  for (const StampedPose& pose : estimated) {
    const bool beyond = !truth.empty() && pose.time > truth.back().time + options.tolerance;
    // With --first N the truth ends early; what comes later is neither right nor wrong.
    if (beyond) break;
    if (NearestInTime(truth, pose.time, options.tolerance, time_of) == truth.size())
      ++errors.without_truth;
  }
  errors.matched = matches.size();
  return matches;
}

void Compare(const std::vector<Match>& matches, const RigidTransform& T_truth_world,
             std::vector<double>& distances_m, std::vector<double>& angles_rad) {
  for (const Match& match : matches) {
    const RigidTransform T_truth_depth = T_truth_world * match.estimated;
    distances_m.push_back(TranslationDistance(T_truth_depth, match.truth));
    angles_rad.push_back(RotationAngle(T_truth_depth, match.truth));
  }
}

}  // namespace

Result<TrajectoryErrors> EvaluateTrajectory(std::span<const StampedPose> estimated,
                                            std::span<const StampedPose> truth,
                                            const TrajectoryEvaluationOptions& options) {
  if (options.first != 0) truth = truth.first(std::min(options.first, truth.size()));
  TrajectoryErrors errors;
  const std::vector<Match> matches = Associate(estimated, truth, options, errors);
  if (matches.empty()) {
    return Err(FailedPrecondition(fmt::format(
        "none of the {} poses has a true pose within {} ms; do both files use the same clock?",
        estimated.size(), 1e3 * ToSeconds(options.tolerance))));
  }
  std::vector<Eigen::Vector3d> from, to;
  for (const Match& match : matches) {
    from.push_back(match.estimated.translation());
    to.push_back(match.truth.translation());
    if (to.size() > 1) errors.length_m += (to.back() - to[to.size() - 2]).norm();
  }
  std::vector<double> aligned_m, aligned_rad, first_m, first_rad;
  // Aligned, the error is that of the shape of the path; from the first pose, it is the drift.
  Compare(matches, AlignRigid(from, to), aligned_m, aligned_rad);
  errors.T_truth_world = matches.front().truth * matches.front().estimated.inverse();
  Compare(matches, errors.T_truth_world, first_m, first_rad);
  errors.aligned_m = Summarize(std::move(aligned_m));
  errors.aligned_rad = Summarize(std::move(aligned_rad));
  errors.from_first_m = Summarize(std::move(first_m));
  errors.from_first_rad = Summarize(std::move(first_rad));
  return errors;
}

}  // namespace isotherm
