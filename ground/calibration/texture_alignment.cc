#include "ground/calibration/texture_alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "common/frame/gaussian_blur.h"
#include "common/radiometry/radiometry.h"
#include "ground/calibration/thermal_sampling.h"

namespace isotherm {
namespace {

// Parts of the scan that are held out, and whose scatter says how certain the result is: shorter
// than the knots of the drift.
constexpr double kPart_s = 0.25;
constexpr int kHeldOutEvery = 3;
// To each side, for the velocity of a point at a frame's time: from one depth frame to the next.
constexpr double kHalfBaseline_s = 0.015;
// How temperatures change with the emission angle has this shape, whatever the material and its
// temperature: next to nothing up to 40 degrees, then ever faster (Fresnel). Its size is fitted at
// each point, unless angles hardly differ.
constexpr double kRefractiveIndex = 1.5;
// Seen at angles that make more of a difference, a place has another apparent temperature: at 300
// kelvin above its surroundings, by a kelvin.
constexpr double kMaxReflectivityChange = 0.003;
// A blur wider than this hides everything.
constexpr double kMaxBlur_px = 20.0;
constexpr double kMinDepth_m = 0.05;
constexpr std::size_t kPointsPerTask = 128;

/// How much later than its frame's stamp the pixel of a point is read, seconds. `p_thermal` has
/// z > 0.
double ReadAfterStamp(const ScanViews& views, const CameraModel& camera,
                      const Eigen::Vector3d& p_thermal) {
  if (views.row_readout_s == 0.0) return 0.0;
  const double row = ProjectNormalized(camera, p_thermal.head<2>() / p_thermal.z()).y();
  return views.row_readout_s * (row - 0.5 * (camera.height - 1));
}

/// Two unit vectors along a surface with the normal `n`.
Eigen::Matrix<double, 3, 2> TangentsOf(const Eigen::Vector3d& n) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = n.unitOrthogonal();
  tangents.col(1) = n.cross(tangents.col(0));
  return tangents;
}

AlignmentEquations NoEquations(int parts, int parameters) {
  AlignmentEquations equations;
  equations.information = Eigen::MatrixXd::Zero(parameters, parameters);
  equations.gradient = Eigen::VectorXd::Zero(parameters);
  equations.part_gradients.assign(static_cast<std::size_t>(parts), equations.gradient);
  return equations;
}

void Add(const AlignmentEquations& from, AlignmentEquations& to) {
  to.information += from.information;
  for (std::size_t i = 0; i < to.part_gradients.size(); ++i)
    to.part_gradients[i] += from.part_gradients[i];
  to.seen_points += from.seen_points;
  to.textured_points += from.textured_points;
}

void AddPoint(const std::vector<PointSample>& samples, AlignmentEquations& equations) {
  const std::optional<PointTexture> texture = TextureOf(samples);
  if (!texture) return;
  ++equations.seen_points;
  if (!texture->is_significant) return;
  ++equations.textured_points;
  const std::vector<PointEpoch> epochs = EpochsOf(samples);
  const std::optional<double> weight = WeightOf(*texture, epochs);
  if (!weight) return;
  for (const PointEpoch& epoch : epochs) AddEpoch(samples, epoch, *texture, *weight, equations);
}

}  // namespace

/// Says how one frame sees, at a placement.
struct TextureAlignment::FrameGeometry {
  bool is_known = false;
  RigidTransform T_thermal_world = RigidTransform::Identity();
  /// A world point's coordinates before the depth camera, and how fast they change with the delay.
  RigidTransform T_depth_world = RigidTransform::Identity();
  Eigen::Matrix<double, 3, 4> velocity_depth_world = Eigen::Matrix<double, 3, 4>::Zero();
  TrajectoryDrift::Place drift;
};

/// Says how held-out frames differ from the others about one point.
struct TextureAlignment::HeldOutPoint {
  double count = 0.0;
  double squares_k2 = 0.0;   ///< Mean of the squared differences.
  double variance_k2 = 0.0;  ///< The others' own.
};

TextureAlignment::TextureAlignment(const ScanViews& views, ThreadPool& pool)
    : views_(views), pool_(pool), showing_(views.points.size()) {
  const double length_s = PartLength(views, kPart_s);
  for (std::size_t i = 0; i < views.frames.size(); ++i) {
    const StampedThermal& frame = views.frames[i];
    const int part = static_cast<int>(ToSeconds(frame.time - views.frames.front().time) / length_s);
    part_of_frame_.push_back(part);
    held_out_.push_back(part % kHeldOutEvery == kHeldOutEvery - 1);
    parts_ = std::max(parts_, part + 1);
    for (const std::uint32_t point : frame.visible)
      showing_[point].push_back(static_cast<std::uint32_t>(i));
  }
}

void TextureAlignment::PrepareImages(const SceneInfluence& influence, double sigma_px,
                                     const std::stop_token& stop) {
  influence_ = Convergent(influence);
  images_.assign(views_.frames.size(), {});
  const std::vector<double> distances_m = Distances();
  std::vector<double> known_m;
  std::copy_if(distances_m.begin(), distances_m.end(), std::back_inserter(known_m),
               [](double distance_m) { return distance_m > 0.0; });
  if (known_m.empty()) return;
  std::nth_element(known_m.begin(), known_m.begin() + known_m.size() / 2, known_m.end());
  const double usual_m = known_m[known_m.size() / 2];
  pool_.ParallelFor(static_cast<int>(views_.frames.size()), [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    if (!(distances_m[i] > 0.0) || stop.stop_requested()) return;
    const StampedThermal& frame = views_.frames[i];
    images_[i] = FindOwnTemperatures(*frame.temperature_raw, frame.scale, influence_);
    if (sigma_px == 0.0) return;
    Image<std::uint16_t>& image = images_[i].temperature_raw;
    image = BlurKnownPixels(
        image, GaussianWeights(std::min(kMaxBlur_px, sigma_px * usual_m / distances_m[i])));
  });
}

std::vector<double> TextureAlignment::Distances() const {
  std::vector<double> distances_m(views_.frames.size());
  for (std::size_t i = 0; i < views_.frames.size(); ++i) {
    const StampedThermal& frame = views_.frames[i];
    const auto T_world_depth =
        InterpolatePose(views_.trajectory, frame.time + FromSeconds(views_.delay_s));
    if (frame.visible.empty() || !T_world_depth) continue;
    const RigidTransform T_thermal_world = views_.T_thermal_depth * T_world_depth->inverse();
    for (const std::uint32_t point : frame.visible)
      distances_m[i] += (T_thermal_world * views_.points[point].p_world).z();
    distances_m[i] /= static_cast<double>(frame.visible.size());
  }
  return distances_m;
}

std::vector<TextureAlignment::FrameGeometry> TextureAlignment::Geometries(
    const ThermalPlacement& placement, const TrajectoryDrift& drift) const {
  std::vector<FrameGeometry> geometries(views_.frames.size());
  for (std::size_t i = 0; i < views_.frames.size(); ++i) {
    if (views_.frames[i].visible.empty()) continue;
    const CaptureTime time = views_.frames[i].time + FromSeconds(placement.delay_s);
    const auto at = InterpolatePose(views_.trajectory, time);
    const auto before = InterpolatePose(views_.trajectory, time - FromSeconds(kHalfBaseline_s));
    const auto after = InterpolatePose(views_.trajectory, time + FromSeconds(kHalfBaseline_s));
    if (!at || !before || !after) continue;
    FrameGeometry& geometry = geometries[i];
    geometry.is_known = true;
    geometry.drift = drift.At(time);
    const RigidTransform motion = drift.MotionAt(geometry.drift);
    geometry.T_depth_world = at->inverse() * motion;
    geometry.T_thermal_world = placement.T_thermal_depth * geometry.T_depth_world;
    geometry.velocity_depth_world =
        (after->inverse().matrix() - before->inverse().matrix()).topRows<3>() /
        (2.0 * kHalfBaseline_s);
  }
  return geometries;
}

void TextureAlignment::Gather(const TexturePoint& point, const std::vector<std::uint32_t>& frames,
                              const ThermalPlacement& placement, const TrajectoryDrift& drift,
                              const std::vector<FrameGeometry>& geometries,
                              std::vector<PointSample>& samples) const {
  samples.clear();
  const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(point.n_world);
  const Eigen::Matrix<double, 3, TrajectoryDrift::kPerKnot> by_knot = drift.ByKnot(point.p_world);
  const Eigen::Matrix3d& R_thermal_depth = placement.T_thermal_depth.linear();
  const Eigen::Vector2d change_of_influence(
      placement.influence.near_fraction - influence_.near_fraction,
      placement.influence.total_fraction - influence_.total_fraction);
  for (const std::uint32_t i : frames) {
    const FrameGeometry& geometry = geometries[i];
    const OwnTemperatures& image = images_[i];
    if (!geometry.is_known || image.temperature_raw.width() == 0) continue;
    const Eigen::Vector3d at_stamp = geometry.T_thermal_world * point.p_world;
    if (at_stamp.z() < kMinDepth_m) continue;
    const Eigen::Vector3d velocity_depth =
        geometry.velocity_depth_world * point.p_world.homogeneous();
    const Eigen::Vector3d turned =
        R_thermal_depth * (geometry.T_depth_world * point.p_world +
                           ReadAfterStamp(views_, placement.camera, at_stamp) * velocity_depth);
    const Eigen::Vector3d p_thermal = turned + placement.T_thermal_depth.translation();
    if (p_thermal.z() < kMinDepth_m) continue;
    const ProjectionDerivatives projection = ProjectWithDerivatives(placement.camera, p_thermal);
    const auto seen =
        SampleThermal(image.temperature_raw, views_.frames[i].scale, projection.pixel);
    if (!seen) continue;
    const Eigen::Matrix<double, 2, 3> by_world_point =
        projection.by_point * geometry.T_thermal_world.linear();
    const Eigen::Matrix2d pixels_per_metre = by_world_point * tangents;
    Eigen::Matrix<double, 2, kPlacementParameters> by_correction;
    by_correction.block<2, 3>(0, kRotationX) = projection.by_point * DerivativeByRotation(turned);
    by_correction.block<2, 3>(0, kTranslationX) = projection.by_point;
    by_correction.col(kDelay) = projection.by_point * (R_thermal_depth * velocity_depth);
    by_correction.block<2, 2>(0, kPrincipalX) = Eigen::Matrix2d::Identity();
    by_correction.rightCols<2>().setZero();
    PointSample sample;
    sample.by_influence = image.ByFractions(projection.pixel);
    sample.kelvin = seen->kelvin + sample.by_influence.dot(change_of_influence);
    sample.gradient_k_m = pixels_per_metre.transpose() * seen->gradient_k_px;
    const Eigen::Matrix2d metres_per_pixel = pixels_per_metre.inverse();
    sample.shift = metres_per_pixel * by_correction;
    sample.drift_shift = metres_per_pixel * (by_world_point * by_knot);
    sample.drift = geometry.drift;
    sample.pixels_per_metre = std::sqrt(std::abs(pixels_per_metre.determinant()));
    const double cosine =
        -(geometry.T_thermal_world.linear() * point.n_world).dot(p_thermal) / p_thermal.norm();
    sample.reflectivity =
        FresnelReflectivity(std::acos(std::clamp(cosine, -1.0, 1.0)), kRefractiveIndex, 0.0);
    sample.part = part_of_frame_[i];
    sample.epoch = views_.frames[i].nuc_epoch;
    sample.held_out = held_out_[i];
    samples.push_back(sample);
  }
}

TextureAlignment::HeldOutPoint TextureAlignment::HeldOutAt(
    const std::vector<PointSample>& samples) {
  const std::vector<PointEpoch> epochs = EpochsOf(samples);
  HeldOutPoint point;
  point.variance_k2 = VarianceOf(epochs).value_or(0.0);
  for (const PointEpoch& epoch : epochs) {
    for (std::size_t i = epoch.begin; i < epoch.end; ++i) {
      if (!samples[i].held_out) continue;
      point.squares_k2 += std::pow(epoch.Difference(samples[i]), 2);
      point.count += 1.0;
    }
  }
  if (point.count > 0.0) point.squares_k2 /= point.count;
  return point;
}

HeldOutComparison TextureAlignment::CompareHeldOut(const ThermalPlacement& before,
                                                   const ThermalPlacement& after,
                                                   std::size_t points) const {
  points = std::min(points, views_.points.size());
  const auto at = [&](const ThermalPlacement& placement) {
    const TrajectoryDrift none;
    const std::vector<FrameGeometry> geometries = Geometries(placement, none);
    std::vector<HeldOutPoint> result(points);
    pool_.ParallelFor(static_cast<int>(points), [&](int index) {
      const auto i = static_cast<std::size_t>(index);
      std::vector<PointSample> samples;
      Gather(views_.points[i], showing_[i], placement, none, geometries, samples);
      result[i] = HeldOutAt(samples);
    });
    return result;
  };
  const std::vector<HeldOutPoint> a = at(before), b = at(after);
  double weights = 0.0, a_squares = 0.0, b_squares = 0.0, a_loss = 0.0, b_loss = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    const double count = std::min(a[i].count, b[i].count);
    if (count == 0.0) continue;
    const double weight = 2.0 * count / (a[i].variance_k2 + b[i].variance_k2);
    weights += weight;
    a_squares += weight * a[i].squares_k2;
    b_squares += weight * b[i].squares_k2;
    a_loss += count * (std::log(a[i].variance_k2) + a[i].squares_k2 / a[i].variance_k2);
    b_loss += count * (std::log(b[i].variance_k2) + b[i].squares_k2 / b[i].variance_k2);
  }
  if (weights == 0.0) return {};
  return {std::sqrt(a_squares / weights), std::sqrt(b_squares / weights), b_loss < a_loss};
}

std::vector<PlaceDifference> TextureAlignment::CompareEpochs(const ThermalPlacement& placement,
                                                             std::size_t points) const {
  points = std::min(points, views_.points.size());
  const TrajectoryDrift none;
  const std::vector<FrameGeometry> geometries = Geometries(placement, none);
  std::vector<std::vector<PlaceDifference>> by_point(points);
  pool_.ParallelFor(static_cast<int>(points), [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    std::vector<PointSample> samples;
    Gather(views_.points[i], showing_[i], placement, none, geometries, samples);
    const std::vector<PointEpoch> epochs = EpochsOf(samples);
    for (std::size_t k = 1; k < epochs.size(); ++k) {
      const PointEpoch& before = epochs[k - 1];
      const PointEpoch& after = epochs[k];
      if (std::abs(after.reflectivity - before.reflectivity) > kMaxReflectivityChange) continue;
      by_point[i].push_back({samples[before.begin].epoch, samples[after.begin].epoch,
                             views_.points[i].p_world, after.kelvin - before.kelvin});
    }
  });
  std::vector<PlaceDifference> differences;
  for (const std::vector<PlaceDifference>& places : by_point)
    differences.insert(differences.end(), places.begin(), places.end());
  return differences;
}

AlignmentEquations TextureAlignment::Linearize(const ThermalPlacement& placement,
                                               const TrajectoryDrift& drift,
                                               std::size_t points) const {
  points = std::min(points, views_.points.size());
  const std::vector<FrameGeometry> geometries = Geometries(placement, drift);
  const std::size_t tasks = (points + kPointsPerTask - 1) / kPointsPerTask;
  const int parameters = kPlacementParameters + drift.size();
  std::vector<AlignmentEquations> by_task(tasks, NoEquations(parts_, parameters));
  pool_.ParallelFor(static_cast<int>(tasks), [&](int index) {
    const auto task = static_cast<std::size_t>(index);
    std::vector<PointSample> samples;
    for (std::size_t i = task * kPointsPerTask; i < std::min(points, (task + 1) * kPointsPerTask);
         ++i) {
      Gather(views_.points[i], showing_[i], placement, drift, geometries, samples);
      AddPoint(samples, by_task[task]);
    }
  });
  AlignmentEquations equations = NoEquations(parts_, parameters);
  for (const AlignmentEquations& one : by_task) Add(one, equations);
  // Only the lower half was summed.
  const Eigen::MatrixXd information = equations.information.selfadjointView<Eigen::Lower>();
  equations.information = information;
  for (const Eigen::VectorXd& gradient : equations.part_gradients) equations.gradient += gradient;
  return equations;
}

}  // namespace isotherm
