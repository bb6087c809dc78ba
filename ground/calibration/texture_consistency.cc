#include "ground/calibration/texture_consistency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/frame/frame.h"
#include "ground/calibration/thermal_sampling.h"

namespace isotherm {
namespace {

// Poses further apart are not interpolated between (thermal.expert.max_depth_gap_s).
constexpr double kMaxGap_s = 0.12;
// A point's variance is weighed by this noise, and by half a pixel of misalignment times its
// gradient: an edge, which half a pixel moves by kelvins, must not count more than a smooth
// pattern. The result hardly depends on them: other weights moved the delay of a rendered furnace
// door by up to 0.4 ms of 42.7 (docs/timing.md). Too little misalignment: edges decide alone.
constexpr double kNoise_k = 0.1;
constexpr double kMisalignment_px = 0.5;
// A point that fewer images show has a variance that is mostly chance.
constexpr double kMinFrames = 8.0;
// More parts cost time and memory (a sum per point and part) and add nothing to the bootstrap,
// which resamples them.
constexpr double kMaxParts = 40.0;

}  // namespace

std::optional<RigidTransform> InterpolatePose(const std::vector<StampedPose>& trajectory,
                                              CaptureTime time) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), time,
                       [](const StampedPose& pose, CaptureTime at) { return pose.time < at; });
  if (after == trajectory.begin() || after == trajectory.end()) return std::nullopt;
  const auto before = after - 1;
  const double gap_s = ToSeconds(after->time - before->time);
  if (gap_s > kMaxGap_s) return std::nullopt;
  return Interpolate(before->T_world_depth, after->T_world_depth,
                     ToSeconds(time - before->time) / gap_s);
}

double PartLength(const ScanViews& views, double part_s) {
  if (views.frames.empty()) return part_s;
  return std::max(part_s,
                  ToSeconds(views.frames.back().time - views.frames.front().time) / kMaxParts);
}

TextureConsistency::TextureConsistency(const ScanViews& views, double part_s,
                                       ComparedImages compared, ThreadPool& pool)
    : views_(views), compared_(compared), pool_(pool) {
  MakeParts(part_s);
  WeighAt(0.0);
}

void TextureConsistency::MakeParts(double part_s) {
  if (views_.frames.empty()) return;
  const CaptureTime start = views_.frames.front().time;
  const double length_s = PartLength(views_, part_s);
  for (std::size_t i = 0; i < views_.frames.size(); ++i) {
    if (views_.frames[i].visible.empty()) continue;
    const auto part = static_cast<std::size_t>(ToSeconds(views_.frames[i].time - start) / length_s);
    if (part >= parts_.size()) parts_.resize(part + 1);
    parts_[part].push_back(i);
  }
  std::erase_if(parts_, [](const std::vector<std::size_t>& part) { return part.empty(); });
}

void TextureConsistency::WeighAt(double delay_s) {
  const std::size_t points = views_.points.size();
  weights_.assign(points, 0.0);
  means_celsius_.assign(points, 0.0);
  const std::vector<std::vector<PointSums>> parts = MeasureParts(delay_s, points);
  for (std::size_t i = 0; i < points; ++i) {
    PointSums sum;
    for (const std::vector<PointSums>& part : parts) {
      sum.count += part[i].count;
      sum.value += part[i].value;
      sum.gradient += part[i].gradient;
    }
    if (sum.count < kMinFrames) continue;
    means_celsius_[i] = sum.value / sum.count;
    const double misaligned_k = kMisalignment_px * sum.gradient / sum.count;
    // Weights are fixed at one delay: if each delay had weights of its own, one that blurs
    // everything would win by small gradients.
    weights_[i] = 1.0 / (kNoise_k * kNoise_k + misaligned_k * misaligned_k);
  }
}

std::vector<double> TextureConsistency::Measure(double delay_s, std::size_t points,
                                                const std::vector<PartWeights>& resamplings) const {
  points = std::min(points, views_.points.size());
  const std::vector<std::vector<PointSums>> parts = MeasureParts(delay_s, points);
  return compared_ == ComparedImages::kOfPart ? VarianceWithinParts(parts, resamplings)
                                              : VarianceOverScan(parts, resamplings);
}

std::vector<double> TextureConsistency::VarianceWithinParts(
    const std::vector<std::vector<PointSums>>& parts,
    const std::vector<PartWeights>& resamplings) const {
  struct PartSums {
    double squares = 0.0, freedom = 0.0;
  };
  std::vector<PartSums> sums(parts.size());
  pool_.ParallelFor(static_cast<int>(parts.size()), [&](int index) {
    const auto part = static_cast<std::size_t>(index);
    for (std::size_t i = 0; i < parts[part].size(); ++i) {
      const PointSums& point = parts[part][i];
      if (!(weights_[i] > 0.0) || point.count < 2.0) continue;
      sums[part].squares +=
          weights_[i] * std::max(0.0, point.squares - point.value * point.value / point.count);
      sums[part].freedom += point.count - 1.0;
    }
  });
  std::vector<double> result;
  for (const PartWeights& times : resamplings) {
    double total = 0.0, freedom = 0.0;
    for (std::size_t part = 0; part < sums.size(); ++part) {
      total += times[part] * sums[part].squares;
      freedom += times[part] * sums[part].freedom;
    }
    result.push_back(freedom > 0.0 ? total / freedom : INFINITY);
  }
  return result;
}

std::vector<double> TextureConsistency::VarianceOverScan(
    const std::vector<std::vector<PointSums>>& parts,
    const std::vector<PartWeights>& resamplings) const {
  std::vector<double> result(resamplings.size());
  const std::size_t points = parts.empty() ? 0 : parts.front().size();
  pool_.ParallelFor(static_cast<int>(resamplings.size()), [&](int index) {
    const PartWeights& times = resamplings[static_cast<std::size_t>(index)];
    double total = 0.0, freedom = 0.0;
    for (std::size_t i = 0; i < points; ++i) {
      double count = 0.0, value = 0.0, squares = 0.0;
      for (std::size_t part = 0; part < parts.size(); ++part) {
        count += times[part] * parts[part][i].count;
        value += times[part] * parts[part][i].value;
        squares += times[part] * parts[part][i].squares;
      }
      if (count < kMinFrames) continue;
      total += weights_[i] * std::max(0.0, squares - value * value / count);
      freedom += weights_[i] > 0.0 ? count - 1.0 : 0.0;
    }
    result[static_cast<std::size_t>(index)] = freedom > 0.0 ? total / freedom : INFINITY;
  });
  return result;
}

std::vector<std::vector<TextureConsistency::PointSums>> TextureConsistency::MeasureParts(
    double delay_s, std::size_t points) const {
  std::vector<std::vector<PointSums>> parts(parts_.size());
  pool_.ParallelFor(static_cast<int>(parts_.size()), [&](int index) {
    const auto part = static_cast<std::size_t>(index);
    parts[part] = MeasurePart(parts_[part], delay_s, points);
  });
  return parts;
}

std::vector<TextureConsistency::PointSums> TextureConsistency::MeasurePart(
    const std::vector<std::size_t>& frames, double delay_s, std::size_t points) const {
  std::vector<PointSums> sums(points);
  for (const std::size_t index : frames) {
    const StampedThermal& frame = views_.frames[index];
    const auto T_world_depth =
        InterpolatePose(views_.trajectory, frame.time + FromSeconds(delay_s));
    if (!T_world_depth) continue;
    const RigidTransform T_thermal_world = views_.T_thermal_depth * T_world_depth->inverse();
    for (const std::uint32_t i : frame.visible) {
      if (i >= points) break;
      const auto pixel = Project(views_.thermal_camera, T_thermal_world * views_.points[i].p_world);
      if (!pixel) continue;
      const std::optional<ThermalSample> sample =
          SampleThermal(*frame.temperature_raw, frame.scale, *pixel);
      if (!sample) continue;
      const double celsius = sample->kelvin - kCelsiusZero_k - means_celsius_[i];
      sums[i].count += 1.0;
      sums[i].value += celsius;
      sums[i].squares += celsius * celsius;
      sums[i].gradient += sample->gradient_k_px.norm();
    }
  }
  return sums;
}

}  // namespace isotherm
