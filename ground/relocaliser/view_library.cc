#include "ground/relocaliser/view_library.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isotherm {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// A view is new if none is nearer than this.
constexpr double kNewViewM = 0.06;
constexpr double kNewViewRad = 10.0 * kRadPerDeg;

/// Guesses nearer than this lead to the same pose.
constexpr double kSameGuessM = 0.04;
constexpr double kSameGuessRad = 6.0 * kRadPerDeg;

constexpr std::size_t kPosesPerCall = 4;

bool IsNear(const RigidTransform& a, const RigidTransform& b, double max_m, double max_rad) {
  return TranslationDistance(a, b) < max_m && RotationAngle(a, b) < max_rad;
}

CameraModel ThumbnailCamera(const CameraModel& depth) {
  CameraModel camera;
  camera.width = Thumbnail::kWidth;
  camera.height = Thumbnail::kHeight;
  const double scale_x = static_cast<double>(camera.width) / depth.width;
  const double scale_y = static_cast<double>(camera.height) / depth.height;
  camera.fx = depth.fx * scale_x;
  camera.fy = depth.fy * scale_y;
  camera.cx = (depth.cx + 0.5) * scale_x - 0.5;
  camera.cy = (depth.cy + 0.5) * scale_y - 0.5;
  return camera;
}

/// Where an operator may have come back to, seen from a known pose: beside, before and behind it,
/// looking elsewhere; or around what was looked at there, at `distance_m`.
std::vector<RigidTransform> MakeOffsets(double distance_m) {
  const auto turn = [](double yaw_deg, double pitch_deg) -> Eigen::Quaterniond {
    return Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(pitch_deg * kRadPerDeg, Eigen::Vector3d::UnitX());
  };
  constexpr double kStepM = 0.09;
  std::vector<Eigen::Vector3d> shifts = {Eigen::Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-kStepM, kStepM})
      shifts.emplace_back(step * Eigen::Vector3d::Unit(axis));
  }
  std::vector<RigidTransform> offsets;
  for (const Eigen::Vector3d& shift : shifts) {
    for (const double yaw : {-12.0, 0.0, 12.0}) {
      for (const double pitch : {-12.0, 0.0, 12.0})
        offsets.push_back(MakeTransform(shift, turn(yaw, pitch)));
    }
  }
  for (const double yaw : {-36.0, -18.0, 0.0, 18.0, 36.0}) {
    for (const double pitch : {-24.0, 0.0, 24.0}) {
      for (const double farther : {-0.25, 0.0, 0.35}) {
        const RigidTransform orbit =
            MakeTransform({0.0, 0.0, distance_m}, turn(yaw, pitch)) *
            MakeTransform({0.0, 0.0, -(1.0 + farther) * distance_m}, turn(0.0, 0.0));
        offsets.push_back(orbit);
      }
    }
  }
  return offsets;
}

/// Median of what is seen; 0 = nothing.
double MedianDepth(const Thumbnail& picture) {
  std::vector<float> seen;
  for (const float z : picture.depth_m) {
    if (z > 0.0F) seen.push_back(z);
  }
  if (seen.empty()) return 0.0;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return static_cast<double>(*middle);
}

/// The best, best first, none near another.
std::vector<PoseGuess> ChooseDistinct(std::vector<PoseGuess> guesses, std::size_t count) {
  std::sort(guesses.begin(), guesses.end(),
            [](const PoseGuess& a, const PoseGuess& b) { return a.disagreement < b.disagreement; });
  std::vector<PoseGuess> best;
  for (const PoseGuess& guess : guesses) {
    constexpr float kHopeless = 0.7F;
    if (guess.disagreement > kHopeless || best.size() == count) break;
    const bool known = std::any_of(best.begin(), best.end(), [&](const PoseGuess& other) {
      return IsNear(other.T_world_depth, guess.T_world_depth, kSameGuessM, kSameGuessRad);
    });
    if (!known) best.push_back(guess);
  }
  return best;
}

}  // namespace

Thumbnail MakeThumbnail(const Image<float>& depth_m) {
  Thumbnail thumbnail;
  const int cell_width = depth_m.width() / Thumbnail::kWidth;
  const int cell_height = depth_m.height() / Thumbnail::kHeight;
  if (cell_width == 0 || cell_height == 0) return thumbnail;
  for (int row = 0; row < Thumbnail::kHeight; ++row) {
    for (int column = 0; column < Thumbnail::kWidth; ++column) {
      float sum = 0.0F;
      int count = 0;
      for (int y = row * cell_height; y < (row + 1) * cell_height; ++y) {
        const auto pixels = depth_m.Row(y).subspan(static_cast<std::size_t>(column * cell_width),
                                                   static_cast<std::size_t>(cell_width));
        for (const float z : pixels) {
          sum += z;
          count += z > 0.0F ? 1 : 0;
        }
      }
      if (3 * count >= cell_width * cell_height) {
        thumbnail.depth_m[static_cast<std::size_t>(row * Thumbnail::kWidth + column)] =
            sum / static_cast<float>(count);
      }
    }
  }
  return thumbnail;
}

float Disagreement(const Thumbnail& picture, const Thumbnail& expected) {
  constexpr float kFullM = 0.08F;  // From this difference on, cells disagree fully.
  float sum = 0.0F;
  float weight = 0.0F;
  int both = 0;
  for (std::size_t i = 0; i < picture.depth_m.size(); ++i) {
    const float a = picture.depth_m[i];
    const float b = expected.depth_m[i];
    if (a > 0.0F && b > 0.0F) {
      sum += std::min(1.0F, std::abs(a - b) / kFullM);
      weight += 1.0F;
      ++both;
    } else if (a > 0.0F) {
      sum += 0.5F;
      weight += 1.0F;
    }
  }
  constexpr int kMinCells = 40;
  return both < kMinCells ? 1.0F : sum / weight;
}

std::vector<Eigen::Vector3f> MakeSurfaceCloud(const TsdfVolume& volume, std::size_t max_points) {
  constexpr int kCellSide = kBlockSide / 2;  // Voxels.
  const VoxelGrid& grid = volume.grid();
  // Voxels within about one of the surface.
  const double near = 1.1 * grid.voxel_size_m / volume.truncation_distance_m();
  std::vector<Eigen::Vector3f> points;
  for (std::int32_t block = 0; block < volume.block_count(); ++block) {
    if (!volume.may_end_rays(block)) continue;
    const GridIndex first = volume.block_coordinates(block) * kBlockSide;
    std::array<Eigen::Vector3i, 8> sums;
    sums.fill(Eigen::Vector3i::Zero());
    std::array<int, 8> counts{};
    int i = 0;
    for (const TsdfVoxel voxel : volume.voxels(block)) {
      const GridIndex local(i & 7, (i >> 3) & 7, i >> 6);
      ++i;
      if (voxel.weight() < 1.0F || std::abs(voxel.tsdf()) > near) continue;
      const GridIndex cell = local / kCellSide;
      const auto k = static_cast<std::size_t>(cell.x() + 2 * cell.y() + 4 * cell.z());
      sums[k] += local;
      ++counts[k];
    }
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (counts[k] == 0) continue;
      const Eigen::Vector3d mean = sums[k].cast<double>() / counts[k] + first.cast<double>();
      points.push_back(
          (grid.min_m + (mean.array() + 0.5).matrix() * grid.voxel_size_m).cast<float>());
    }
  }
  // Thinned out evenly: one point per cell of a grid that gets coarser until it is enough.
  for (double spacing = 1.4 * kCellSide * grid.voxel_size_m; points.size() > max_points;
       spacing *= 1.4) {
    const auto cell_of = [&](const Eigen::Vector3f& p) -> std::array<int, 3> {
      const Eigen::Vector3i cell = (p.cast<double>() / spacing).array().floor().cast<int>();
      return {cell.x(), cell.y(), cell.z()};
    };
    std::sort(points.begin(), points.end(),
              [&](const auto& a, const auto& b) { return cell_of(a) < cell_of(b); });
    points.erase(
        std::unique(points.begin(), points.end(),
                    [&](const auto& a, const auto& b) { return cell_of(a) == cell_of(b); }),
        points.end());
  }
  return points;
}

ViewLibrary::ViewLibrary(const CameraModel& depth_camera, int max_views)
    : camera_(ThumbnailCamera(depth_camera)), max_views_(static_cast<std::size_t>(max_views)) {}

void ViewLibrary::Add(const RigidTransform& T_world_depth) {
  if (poses_.size() >= max_views_) return;
  // The newest are the likeliest to be near.
  const bool known = std::any_of(poses_.rbegin(), poses_.rend(), [&](const RigidTransform& pose) {
    return IsNear(pose, T_world_depth, kNewViewM, kNewViewRad);
  });
  if (!known) poses_.push_back(T_world_depth);
}

Thumbnail ViewLibrary::Look(const RigidTransform& T_world_depth) const {
  Thumbnail picture;
  const Eigen::Matrix<float, 3, 4> T = T_world_depth.inverse().matrix().topRows<3>().cast<float>();
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx) + 0.5F;
  const auto cy = static_cast<float>(camera_.cy) + 0.5F;
  constexpr float kNearestM = 0.1F;
  for (const Eigen::Vector3f& p : cloud_) {
    const float z = T(2, 0) * p.x() + T(2, 1) * p.y() + T(2, 2) * p.z() + T(2, 3);
    if (z < kNearestM) continue;
    const float x = T(0, 0) * p.x() + T(0, 1) * p.y() + T(0, 2) * p.z() + T(0, 3);
    const float y = T(1, 0) * p.x() + T(1, 1) * p.y() + T(1, 2) * p.z() + T(1, 3);
    const float u = fx * x / z + cx;
    const float v = fy * y / z + cy;
    if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(Thumbnail::kWidth) &&
          v < static_cast<float>(Thumbnail::kHeight))) {
      continue;
    }
    float& cell = picture.depth_m[static_cast<std::size_t>(static_cast<int>(v) * Thumbnail::kWidth +
                                                           static_cast<int>(u))];
    if (cell == 0.0F || z < cell) cell = z;
  }
  return picture;
}

PoseGuess ViewLibrary::Improve(const Thumbnail& picture, PoseGuess guess) const {
  constexpr int kRounds = 3;
  double step_m = 0.045;
  double step_rad = 7.0 * kRadPerDeg;
  for (int round = 0; round < kRounds; ++round) {
    bool better = false;
    for (int axis = 0; axis < 6; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d unit = sign * Eigen::Vector3d::Unit(axis % 3);
        const RigidTransform offset =
            axis < 3 ? MakeTransform(step_m * unit, Eigen::Quaterniond::Identity())
                     : MakeTransform(Eigen::Vector3d::Zero(),
                                     Eigen::Quaterniond(Eigen::AngleAxisd(step_rad, unit)));
        const RigidTransform pose = guess.T_world_depth * offset;
        const float disagreement = Disagreement(picture, Look(pose));
        if (disagreement >= guess.disagreement) continue;
        guess = {pose, disagreement};
        better = true;
      }
    }
    if (better) continue;
    step_m *= 0.5;
    step_rad *= 0.5;
  }
  return guess;
}

std::vector<PoseGuess> ViewLibrary::Guess(const Thumbnail& picture, int max_guesses,
                                          ThreadPool& pool) {
  const double distance_m = MedianDepth(picture);
  if (poses_.empty() || cloud_.empty() || distance_m == 0.0) return {};
  const std::vector<RigidTransform> offsets = MakeOffsets(distance_m);
  const std::size_t count = std::min(poses_.size(), kPosesPerCall);
  std::vector<PoseGuess> all(count * offsets.size());
  pool.ParallelFor(static_cast<int>(all.size()), [&](int task) {
    const auto i = static_cast<std::size_t>(task);
    const RigidTransform& pose = poses_[(next_pose_ + i / offsets.size()) % poses_.size()];
    const RigidTransform guess = pose * offsets[i % offsets.size()];
    all[i] = {guess, Disagreement(picture, Look(guess))};
  });
  next_pose_ = (next_pose_ + count) % poses_.size();
  constexpr std::size_t kImproved = 6;
  std::vector<PoseGuess> best = ChooseDistinct(std::move(all), kImproved);
  pool.ParallelFor(static_cast<int>(best.size()), [&](int task) {
    PoseGuess& guess = best[static_cast<std::size_t>(task)];
    guess = Improve(picture, guess);
  });
  return ChooseDistinct(std::move(best), static_cast<std::size_t>(max_guesses));
}

}  // namespace isotherm
