#include "ground/camera_calibration/target_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "common/base/units.h"
#include "ground/camera_calibration/starting_values.h"

namespace isotherm {
namespace {

/// The bound is for what would never settle.
constexpr int kMaxRounds = 8;
/// A round that moves no feature's prediction by more than this ends them.
constexpr double kSettled_px = 1e-3;

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Carries a calibration from round to round.
class Calibrator {
 public:
  Calibrator(const CalibrationInput& input, std::vector<SeenTarget> seen, ThreadPool& pool)
      : input_(input), seen_(std::move(seen)), pool_(pool) {
    result_.target = input.target;
  }

  Result<TargetCalibration> Run(const CalibrationProgress& progress) {
    if (Status status = Start(); !status.ok()) return Err(status);
    for (int round = 0; round < kMaxRounds; ++round) {
      const BundleState before = result_.state;
      Measure(round);
      if (result_.observations.empty())
        return Err(FailedPrecondition("no feature can be measured in these images"));
      Result<BundleFit> fit = SolveBundle(input_.target, result_.observations, {}, result_.state);
      if (!fit) return Err(fit.error());
      result_.fit = std::move(*fit);
      progress(static_cast<double>(round + 1) / kMaxRounds);
      // Images that disagree go once the others are near the truth.
      const bool refused = round >= 1 && RefuseOutliers();
      if (Status status = CheckEnough(); !status.ok()) return Err(status);
      if (!refused && round >= 3 && Moved(before) < kSettled_px) break;
    }
    return Finish();
  }

 private:
  Status Start() {
    Result<StartingValues> start = FindStart(input_, seen_);
    if (!start) return start.error();
    result_.state = std::move(start->state);
    for (std::size_t camera = 0; camera < input_.camera_names.size(); ++camera) {
      HoleAppearance hole;
      hole.diameter_m = input_.target.hole_m.value_or(0.0);
      for (const SeenTarget& seen : seen_) {
        if (hole.diameter_m > 0.0 || seen.camera != static_cast<int>(camera)) continue;
        hole.diameter_m = GuessHoleSize(ImageOf(seen), input_.target, seen.detected.features);
      }
      // Without a thickness there is no wall to look at.
      hole.wall_known = input_.target.thickness_m == 0.0;
      result_.holes.push_back(hole);
    }
    return OkStatus();
  }

  const Image<float>& ImageOf(const SeenTarget& seen) const {
    return input_.views[static_cast<std::size_t>(seen.view)]
        .images[static_cast<std::size_t>(seen.camera)];
  }

  void Measure(int round) {
    std::vector<std::vector<FeatureMeasurement>> measured(seen_.size());
    pool_.ParallelFor(static_cast<int>(seen_.size()), [&](int i) {
      const auto index = static_cast<std::size_t>(i);
      measured[index] = MeasureImage(seen_[index]);
    });
    result_.observations.clear();
    for (const auto& features : measured) {
      for (const FeatureMeasurement& feature : features)
        result_.observations.push_back(feature.observation);
    }
    if (input_.target.HasHoles()) LearnHoles(measured, round);
  }

  /// Says if the camera looks into a hole by less than kMaxAside from its axis. From farther aside
  /// walls and edges hide a part of what is behind that the model, which has one wall of one
  /// brightness, does not know: with holes up to 70 degrees aside lenses were 0.03 px off where
  /// 0.012 px was said (ten simulated sessions).
  bool IsSeenFromFront(const SeenTarget& seen, int feature) const {
    constexpr double kMaxAside = 45.0 * kRadPerDeg;
    const RigidTransform T_camera_board =
        result_.state.cameras[static_cast<std::size_t>(seen.camera)].T_camera_rig *
        result_.state.T_rig_board[static_cast<std::size_t>(seen.view)];
    const Eigen::Vector2d xy = input_.target.FeaturePosition(feature);
    const Eigen::Vector3d line_of_sight = T_camera_board * Eigen::Vector3d(xy.x(), xy.y(), 0.0);
    return line_of_sight.normalized().dot(T_camera_board.linear().col(2)) > std::cos(kMaxAside);
  }

  std::vector<FeatureMeasurement> MeasureImage(const SeenTarget& seen) const {
    const Image<float>& image = ImageOf(seen);
    if (!input_.target.HasHoles())
      return MeasureCorners(image, seen.detected.features, input_.target, seen.camera, seen.view);
    std::vector<FeatureMeasurement> all, from_front;
    std::vector<int> in_front;
    for (int i = 0; i < input_.target.features(); ++i) {
      const auto measurement = MeasureHole(
          image, result_.state, input_.target, result_.holes[static_cast<std::size_t>(seen.camera)],
          seen.camera, seen.view, i, seen.detected.features[static_cast<std::size_t>(i)]);
      if (!measurement) continue;
      all.push_back(*measurement);
      if (input_.target.thickness_m > 0.0 && !IsSeenFromFront(seen, i)) continue;
      from_front.push_back(*measurement);
      in_front.push_back(i);
    }
    return input_.target.TellPose(in_front) ? from_front : all;
  }

  /// Takes over from all holes what they have in common: it is known better from all of them than
  /// from one.
  void LearnHoles(const std::vector<std::vector<FeatureMeasurement>>& measured, int round) {
    for (std::size_t camera = 0; camera < result_.holes.size(); ++camera) {
      std::vector<double> blurs, scales;
      double wall = 0.0, weight = 0.0;
      for (const auto& features : measured) {
        for (const FeatureMeasurement& feature : features) {
          if (feature.observation.camera != static_cast<int>(camera)) continue;
          blurs.push_back(feature.blur_px);
          scales.push_back(feature.scale);
          if (!(feature.wall_sigma > 0.0)) continue;
          const double information = 1.0 / (feature.wall_sigma * feature.wall_sigma);
          wall += information * feature.wall_fill;
          weight += information;
        }
      }
      if (blurs.empty()) continue;
      HoleAppearance& hole = result_.holes[camera];
      hole.blur_px = MedianOf(blurs);
      hole.diameter_m *= MedianOf(scales);
      if (hole.wall_known) continue;
      if (weight > 0.0) hole.wall_fill = std::clamp(wall / weight, -0.5, 1.5);
      hole.wall_known = round >= 2;
    }
  }

  /// Takes out images whose features disagree with all others much more than these among
  /// themselves. Returns whether there was one.
  bool RefuseOutliers() {
    std::map<std::pair<int, int>, std::pair<double, int>> sums;
    for (std::size_t i = 0; i < result_.observations.size(); ++i) {
      const FeatureObservation& o = result_.observations[i];
      auto& [sum, count] = sums[{o.camera, o.view}];
      sum += result_.fit.residuals_px[i].squaredNorm();
      ++count;
    }
    std::vector<double> all;
    for (const auto& [key, value] : sums) all.push_back(std::sqrt(value.first / value.second));
    // A view this much worse than the others moved, or was taken for another part of the target.
    // Smaller: sound views of a poor camera are refused; larger: one wrong view bends the lens.
    constexpr double kTimesMedian = 4.0, kMin_px = 0.15;
    const double limit = std::max(kMin_px, kTimesMedian * MedianOf(all));
    bool refused = false;
    for (const auto& [key, value] : sums) {
      const double rms = std::sqrt(value.first / value.second);
      if (rms <= limit) continue;
      Refuse(key.first, key.second,
             fmt::format("its features are {:.2f} px off what all other images agree on: did the "
                         "target move or bend, or is something before it?",
                         rms));
      refused = true;
    }
    return refused;
  }

  void Refuse(int camera, int view, std::string reason) {
    result_.refused.push_back({input_.views[static_cast<std::size_t>(view)].name,
                               input_.camera_names[static_cast<std::size_t>(camera)],
                               std::move(reason)});
    std::erase_if(
        seen_, [&](const SeenTarget& seen) { return seen.camera == camera && seen.view == view; });
    std::erase_if(result_.observations, [&](const FeatureObservation& o) {
      return o.camera == camera && o.view == view;
    });
  }

  Status CheckEnough() const { return CheckViews(input_, seen_); }

  /// How far the predictions of features moved since `before`, pixels.
  double Moved(const BundleState& before) const {
    double moved = 0.0;
    for (const FeatureObservation& o : result_.observations) {
      const auto at = [&](const BundleState& state) {
        return ProjectBoardPoint(state, input_.target, o.camera, o.view, o.feature,
                                 Eigen::Vector2d::Zero(), 0.0);
      };
      moved = std::max(moved, (at(result_.state) - at(before)).norm());
    }
    return moved;
  }

  /// Numbers the views that are left, and says how certain all is.
  Result<TargetCalibration> Finish() {
    std::set<int> used;
    for (const FeatureObservation& o : result_.observations) used.insert(o.view);
    std::map<int, int> number;
    std::vector<RigidTransform> poses;
    for (const int view : used) {
      number[view] = static_cast<int>(poses.size());
      poses.push_back(result_.state.T_rig_board[static_cast<std::size_t>(view)]);
      result_.view_names.push_back(input_.views[static_cast<std::size_t>(view)].name);
    }
    result_.state.T_rig_board = poses;
    for (FeatureObservation& o : result_.observations) o.view = number[o.view];
    const std::size_t cameras = input_.camera_names.size();
    result_.sizes_px.resize(cameras);
    result_.detections.assign(cameras,
                              std::vector<std::vector<Eigen::Vector2d>>(result_.view_names.size()));
    for (const SeenTarget& seen : seen_) {
      const auto camera = static_cast<std::size_t>(seen.camera);
      result_.sizes_px[camera] = {ImageOf(seen).width(), ImageOf(seen).height()};
      if (!number.contains(seen.view)) continue;
      result_.detections[camera][static_cast<std::size_t>(number[seen.view])] =
          seen.detected.features;
    }
    Result<BundleFit> fit = SolveBundle(input_.target, result_.observations, {}, result_.state);
    if (!fit) return Err(fit.error());
    result_.fit = std::move(*fit);
    Result<ReducedSystem> system =
        ReduceBundle(input_.target, result_.observations, {}, result_.state);
    if (!system) return Err(system.error());
    result_.system = std::move(*system);
    return std::move(result_);
  }

  const CalibrationInput& input_;
  std::vector<SeenTarget> seen_;
  ThreadPool& pool_;
  TargetCalibration result_;
};

}  // namespace

Eigen::MatrixXd TargetCalibration::LensCovariance(int camera) const {
  const int at = system.lens_at[static_cast<std::size_t>(camera)];
  const int count = LensParameterCount(state.cameras[static_cast<std::size_t>(camera)].kind);
  // Features that agree better than expected may all be off alike.
  return std::max(1.0, fit.variance_factor) * system.Covariance().block(at, at, count, count);
}

Result<TargetCalibration> CalibrateWithTarget(const CalibrationInput& input, ThreadPool& pool,
                                              const CalibrationProgress& progress) {
  constexpr double kDetecting = 0.4;  // Of the time.
  std::vector<RefusedImage> refused;
  Result<std::vector<SeenTarget>> seen = DetectInAll(
      input, pool, [&](double part) { progress(kDetecting * part); }, refused);
  if (!seen) return Err(seen.error());
  Result<TargetCalibration> result =
      Calibrator(input, std::move(*seen), pool).Run([&](double part) {
        progress(kDetecting + (1.0 - kDetecting) * part);
      });
  if (result) result->refused.insert(result->refused.begin(), refused.begin(), refused.end());
  return result;
}

}  // namespace isotherm
