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
// As in TextureConsistency: what a sample differs by without any fault of the calibration.
constexpr double kNoise_k = 0.1;
constexpr double kMisalignment_px = 0.5;
// A mean of fewer frames is mostly one frame's noise.
constexpr double kMinFrames = 8.0, kMinFramesOfEpoch = 4.0;
// The squared gradient over its squared standard error: noise alone is above it at one of 22,000
// points (exp(-10), for two directions and many frames; at one of 500 for the fewest).
constexpr double kMinSignificance = 10.0;
// To each side, for the velocity of a point at a frame's time: from one depth frame to the next.
constexpr double kHalfBaseline_s = 0.015;
// How temperatures change with the emission angle has this shape, whatever the material and its
// temperature: next to nothing up to 40 degrees, then ever faster (Fresnel). Its size is fitted at
// each point, unless angles hardly differ.
constexpr double kRefractiveIndex = 1.5;
constexpr double kMinReflectivitySpread = 0.0001;
// A blur wider than this hides everything.
constexpr double kMaxBlur_px = 20.0;
constexpr double kMinDepth_m = 0.05;
constexpr std::size_t kPointsPerTask = 128;

/// Two unit vectors along a surface with the normal `n`.
Eigen::Matrix<double, 3, 2> TangentsOf(const Eigen::Vector3d& n) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = n.unitOrthogonal();
  tangents.col(1) = n.cross(tangents.col(0));
  return tangents;
}

}  // namespace

/// How one frame sees, at a placement.
struct TextureAlignment::FrameGeometry {
  bool is_known = false;
  RigidTransform T_thermal_world = RigidTransform::Identity();
  /// A world point's coordinates before the depth camera, and how fast they change with the delay.
  RigidTransform T_depth_world = RigidTransform::Identity();
  Eigen::Matrix<double, 3, 4> velocity_depth_world = Eigen::Matrix<double, 3, 4>::Zero();
  TrajectoryDrift::Place drift;
};

/// Holds what one frame shows of one point.
struct TextureAlignment::Sample {
  double kelvin = 0.0;
  Eigen::Vector2d gradient_k_m;  ///< Along the surface.
  /// Where on the surface the pixel of the point lies after a correction, metres per unit.
  Eigen::Matrix<double, 2, kPlacementParameters> shift;
  Eigen::Matrix<double, 2, TrajectoryDrift::kPerKnot> drift_shift;  ///< The same by a knot.
  TrajectoryDrift::Place drift;
  double pixels_per_metre = 0.0;
  double reflectivity = 0.0;  ///< A dielectric surface's, seen at this emission angle.
  int part = 0;
  std::uint8_t epoch = 0;
  bool held_out = false;
};

struct TextureAlignment::Sums {
  Sums(int parts, int parameters) {
    equations.information = Eigen::MatrixXd::Zero(parameters, parameters);
    equations.gradient = Eigen::VectorXd::Zero(parameters);
    equations.part_gradients.assign(static_cast<std::size_t>(parts), equations.gradient);
  }
  void Add(const Sums& other) {
    AlignmentEquations& to = equations;
    const AlignmentEquations& from = other.equations;
    to.information += from.information;
    for (std::size_t i = 0; i < to.part_gradients.size(); ++i)
      to.part_gradients[i] += from.part_gradients[i];
    to.seen_points += from.seen_points;
    to.textured_points += from.textured_points;
  }

  AlignmentEquations equations;
};

/// Says how the temperature changes along the surface at a point, by the frames that are not held
/// out.
struct TextureAlignment::PointTexture {
  Eigen::Vector2d gradient_k_m = Eigen::Vector2d::Zero();
  double mean_slope_k_px = 0.0;  ///< The mean of single images' own gradients.
  bool is_significant = false;   ///< The gradient is above what noise makes.
};

/// The samples [begin, end) of a point between two NUCs, and what they are compared with: a
/// temperature and its change with the emission angle, fitted to those that are not held out.
struct TextureAlignment::Epoch {
  std::size_t begin = 0, end = 0;
  double count = 0.0;  ///< Samples that are not held out; the rest is about them.
  double kelvin = 0.0, reflectivity = 0.0;  ///< Means.
  double kelvin_by_reflectivity = 0.0;
  double reflectivity_squares = 0.0;  ///< Sum over the samples, about the mean.
  double squares = 0.0;               ///< Sum over the differences, K^2.

  double Difference(const Sample& sample) const {
    return sample.kelvin - kelvin - kelvin_by_reflectivity * (sample.reflectivity - reflectivity);
  }
};

/// Says how held-out frames differ from the others about one point.
struct TextureAlignment::HeldOutPoint {
  double count = 0.0;
  double squares_k2 = 0.0;   ///< Mean of the squared differences.
  double variance_k2 = 0.0;  ///< The others' own.
};

std::optional<TextureAlignment::PointTexture> TextureAlignment::TextureOf(
    const std::vector<Sample>& samples) {
  PointTexture texture;
  double count = 0.0, squares = 0.0;
  for (const Sample& sample : samples) {
    if (sample.held_out) continue;
    count += 1.0;
    texture.gradient_k_m += sample.gradient_k_m;
    texture.mean_slope_k_px += sample.gradient_k_m.norm() / sample.pixels_per_metre;
    squares += sample.gradient_k_m.squaredNorm();
  }
  if (count < kMinFrames) return std::nullopt;
  texture.gradient_k_m /= count;
  texture.mean_slope_k_px /= count;
  const double scatter = squares / count - texture.gradient_k_m.squaredNorm();
  texture.is_significant = texture.gradient_k_m.squaredNorm() >
                           kMinSignificance * std::max(0.0, scatter) / (count - 1.0);
  return texture;
}

void TextureAlignment::Complete(const std::vector<Sample>& samples, Epoch& epoch) {
  const auto for_each = [&](const auto& add) {
    for (std::size_t i = epoch.begin; i < epoch.end; ++i) {
      if (!samples[i].held_out) add(samples[i]);
    }
  };
  for_each([&](const Sample& sample) {
    epoch.count += 1.0;
    epoch.kelvin += sample.kelvin;
    epoch.reflectivity += sample.reflectivity;
  });
  if (epoch.count == 0.0) return;
  epoch.kelvin /= epoch.count;
  epoch.reflectivity /= epoch.count;
  epoch.reflectivity_squares = kMinReflectivitySpread * kMinReflectivitySpread * epoch.count;
  for_each([&](const Sample& sample) {
    const double reflectivity = sample.reflectivity - epoch.reflectivity;
    epoch.reflectivity_squares += reflectivity * reflectivity;
    epoch.kelvin_by_reflectivity += reflectivity * sample.kelvin;
  });
  epoch.kelvin_by_reflectivity /= epoch.reflectivity_squares;
  for_each([&](const Sample& sample) {
    const double difference_k = epoch.Difference(sample);
    epoch.squares += difference_k * difference_k;
  });
}

std::vector<TextureAlignment::Epoch> TextureAlignment::EpochsOf(
    const std::vector<Sample>& samples) {
  std::vector<Epoch> epochs;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    while (end < samples.size() && samples[end].epoch == samples[begin].epoch) ++end;
    Epoch epoch{begin, end};
    Complete(samples, epoch);
    if (epoch.count >= kMinFramesOfEpoch) epochs.push_back(epoch);
  }
  return epochs;
}

std::optional<double> TextureAlignment::Variance(const std::vector<Epoch>& epochs) {
  double count = 0.0, squares = 0.0;
  for (const Epoch& epoch : epochs) {
    count += epoch.count;
    squares += epoch.squares;
  }
  if (count == 0.0) return std::nullopt;
  return kNoise_k * kNoise_k + squares / count;
}

TextureAlignment::TextureAlignment(const ScanViews& views, bool hold_out, ThreadPool& pool)
    : views_(views), pool_(pool), showing_(views.points.size()) {
  const double length_s = PartLength(views, kPart_s);
  for (std::size_t i = 0; i < views.frames.size(); ++i) {
    const StampedThermal& frame = views.frames[i];
    const int part = static_cast<int>(ToSeconds(frame.time - views.frames.front().time) / length_s);
    part_of_frame_.push_back(part);
    held_out_.push_back(hold_out && part % kHeldOutEvery == kHeldOutEvery - 1);
    parts_ = std::max(parts_, part + 1);
    for (const std::uint32_t point : frame.visible)
      showing_[point].push_back(static_cast<std::uint32_t>(i));
  }
}

void TextureAlignment::BlurImages(double sigma_px) {
  const std::vector<double> distances_m = Distances();
  std::vector<double> known_m;
  is_blurred_ = sigma_px > 0.0;
  if (!is_blurred_) return;
  std::copy_if(distances_m.begin(), distances_m.end(), std::back_inserter(known_m),
               [](double distance_m) { return distance_m > 0.0; });
  if (known_m.empty()) return;
  std::nth_element(known_m.begin(), known_m.begin() + known_m.size() / 2, known_m.end());
  const double usual_m = known_m[known_m.size() / 2];
  blurred_.resize(views_.frames.size());
  pool_.ParallelFor(static_cast<int>(views_.frames.size()), [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    if (!(distances_m[i] > 0.0)) return;
    blurred_[i] = BlurKnownPixels(
        *views_.frames[i].temperature_raw,
        GaussianWeights(std::min(kMaxBlur_px, sigma_px * usual_m / distances_m[i])));
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
                              std::vector<Sample>& samples) const {
  samples.clear();
  const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(point.n_world);
  const Eigen::Matrix3d& R_thermal_depth = placement.T_thermal_depth.linear();
  for (const std::uint32_t i : frames) {
    const FrameGeometry& geometry = geometries[i];
    if (!geometry.is_known || (is_blurred_ && blurred_[i].width() == 0)) continue;
    const Eigen::Vector3d p_depth = geometry.T_depth_world * point.p_world;
    const Eigen::Vector3d turned = R_thermal_depth * p_depth;
    const Eigen::Vector3d p_thermal = turned + placement.T_thermal_depth.translation();
    if (p_thermal.z() < kMinDepth_m) continue;
    const ProjectionDerivatives projection = ProjectWithDerivatives(placement.camera, p_thermal);
    const auto seen = SampleThermal(is_blurred_ ? blurred_[i] : *views_.frames[i].temperature_raw,
                                    views_.frames[i].scale, projection.pixel);
    if (!seen) continue;
    const Eigen::Matrix<double, 2, 3> by_world_point =
        projection.by_point * geometry.T_thermal_world.linear();
    const Eigen::Matrix2d pixels_per_metre = by_world_point * tangents;
    Eigen::Matrix<double, 2, kPlacementParameters> by_correction;
    by_correction.block<2, 3>(0, kRotationX) = projection.by_point * DerivativeByRotation(turned);
    by_correction.block<2, 3>(0, kTranslationX) = projection.by_point;
    by_correction.col(kDelay) =
        projection.by_point *
        (R_thermal_depth * (geometry.velocity_depth_world * point.p_world.homogeneous()));
    by_correction.block<2, 2>(0, kPrincipalX) = Eigen::Matrix2d::Identity();
    Sample sample;
    sample.kelvin = seen->kelvin;
    sample.gradient_k_m = pixels_per_metre.transpose() * seen->gradient_k_px;
    const Eigen::Matrix2d metres_per_pixel = pixels_per_metre.inverse();
    sample.shift = metres_per_pixel * by_correction;
    sample.drift_shift = metres_per_pixel * (by_world_point * drift.ByKnot(point.p_world));
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

void TextureAlignment::AddEpoch(const std::vector<Sample>& samples, const Epoch& epoch,
                                const PointTexture& texture, double weight, Eigen::MatrixXd& slopes,
                                Sums& sums) {
  // By parameter and sample.
  const Eigen::Index parameters = sums.equations.gradient.size();
  slopes.setZero(parameters, static_cast<Eigen::Index>(epoch.count));
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(parameters), by_reflectivity = mean;
  Eigen::Index column = 0;
  for (std::size_t i = epoch.begin; i < epoch.end; ++i) {
    const Sample& sample = samples[i];
    if (sample.held_out) continue;
    auto slope = slopes.col(column++);
    slope.head<kPlacementParameters>() = sample.shift.transpose() * texture.gradient_k_m;
    if (parameters > kPlacementParameters) {
      const Eigen::Matrix<double, TrajectoryDrift::kPerKnot, 1> drift =
          sample.drift_shift.transpose() * texture.gradient_k_m;
      const Eigen::Index first = kPlacementParameters + sample.drift.first;
      slope.segment<TrajectoryDrift::kPerKnot>(first) = (1.0 - sample.drift.fraction) * drift;
      slope.segment<TrajectoryDrift::kPerKnot>(first + TrajectoryDrift::kPerKnot) =
          sample.drift.fraction * drift;
    }
    mean += slope;
    by_reflectivity += (sample.reflectivity - epoch.reflectivity) * slope;
  }
  mean /= epoch.count;
  by_reflectivity /= epoch.reflectivity_squares;
  column = 0;
  for (std::size_t i = epoch.begin; i < epoch.end; ++i) {
    const Sample& sample = samples[i];
    if (sample.held_out) continue;
    auto slope = slopes.col(column++);
    slope -= mean + (sample.reflectivity - epoch.reflectivity) * by_reflectivity;
    sums.equations.part_gradients[static_cast<std::size_t>(sample.part)] +=
        weight * epoch.Difference(sample) * slope;
  }
  sums.equations.information.selfadjointView<Eigen::Lower>().rankUpdate(slopes, weight);
}

void TextureAlignment::AddPoint(const std::vector<Sample>& samples, Eigen::MatrixXd& slopes,
                                Sums& sums) {
  const std::optional<PointTexture> texture = TextureOf(samples);
  if (!texture) return;
  ++sums.equations.seen_points;
  if (!texture->is_significant) return;
  ++sums.equations.textured_points;
  const std::vector<Epoch> epochs = EpochsOf(samples);
  const std::optional<double> variance_k2 = Variance(epochs);
  if (!variance_k2) return;
  const double edge_k = kMisalignment_px * texture->mean_slope_k_px;
  for (const Epoch& epoch : epochs) {
    AddEpoch(samples, epoch, *texture, 1.0 / (*variance_k2 + edge_k * edge_k), slopes, sums);
  }
}

TextureAlignment::HeldOutPoint TextureAlignment::HeldOutAt(const std::vector<Sample>& samples) {
  const std::vector<Epoch> epochs = EpochsOf(samples);
  HeldOutPoint point;
  point.variance_k2 = Variance(epochs).value_or(0.0);
  for (const Epoch& epoch : epochs) {
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
      std::vector<Sample> samples;
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

AlignmentEquations TextureAlignment::Linearize(const ThermalPlacement& placement,
                                               const TrajectoryDrift& drift,
                                               std::size_t points) const {
  points = std::min(points, views_.points.size());
  const std::vector<FrameGeometry> geometries = Geometries(placement, drift);
  const std::size_t tasks = (points + kPointsPerTask - 1) / kPointsPerTask;
  const int parameters = kPlacementParameters + drift.size();
  std::vector<Sums> sums(tasks, Sums(parts_, parameters));
  pool_.ParallelFor(static_cast<int>(tasks), [&](int index) {
    const auto task = static_cast<std::size_t>(index);
    std::vector<Sample> samples;
    Eigen::MatrixXd slopes;
    for (std::size_t i = task * kPointsPerTask; i < std::min(points, (task + 1) * kPointsPerTask);
         ++i) {
      Gather(views_.points[i], showing_[i], placement, drift, geometries, samples);
      AddPoint(samples, slopes, sums[task]);
    }
  });
  Sums total(parts_, parameters);
  for (const Sums& sum : sums) total.Add(sum);
  AlignmentEquations& equations = total.equations;
  equations.information = equations.information.selfadjointView<Eigen::Lower>();
  for (const Eigen::VectorXd& gradient : equations.part_gradients) equations.gradient += gradient;
  return std::move(equations);
}

}  // namespace isotherm
