#include "ground/relocaliser/keyframe_database.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/quantile.h"
#include "common/base/units.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {
namespace {

/// A view is new if none is nearer than this. The poses around each (MakeOffsets) reach 9 cm and 12
/// degrees further, so that those of neighbours overlap. Smaller: more views, each of which takes
/// its time once a loss; larger: gaps between them. Not tuned; with all of these the rig is found
/// again from 287 of 300 starts within 15 cm and 20 degrees of its path (docs/performance.md).
constexpr double kNewView_m = 0.06;
constexpr double kNewView_rad = 10.0 * kRadPerDeg;

/// Guesses nearer than this lead to the same pose: the refinement reaches further (kFirstStage: 12
/// cm). Larger: a right guess beside a wrong one is dropped; smaller: one place takes all the
/// tries. Not tuned.
constexpr double kSameGuess_m = 0.04;
constexpr double kSameGuess_rad = 6.0 * kRadPerDeg;

// Known poses that are tried per lost frame, in turns. The search of one frame takes as long
// whatever the scan's length. More: slower frames while lost; fewer: more of them. Not tuned.
constexpr std::size_t kPosesPerCall = 3;

bool IsNear(const RigidTransform& a, const RigidTransform& b, double max_m, double max_rad) {
  return TranslationDistance(a, b) < max_m && RotationAngle(a, b) < max_rad;
}

CameraModel ThumbnailCamera(const CameraModel& depth) {
  CameraModel camera;
  camera.width = Thumbnail::kWidth;
  camera.height = Thumbnail::kHeight;
  // Cells are whole pixels; what is left over at the right and below is not looked at.
  const double scale_x = 1.0 / std::max(1, depth.width / camera.width);
  const double scale_y = 1.0 / std::max(1, depth.height / camera.height);
  camera.fx = depth.fx * scale_x;
  camera.fy = depth.fy * scale_y;
  // Pixel centres are at whole numbers, so half a pixel is added before scaling and taken off
  // after.
  camera.cx = (depth.cx + 0.5) * scale_x - 0.5;
  camera.cy = (depth.cy + 0.5) * scale_y - 0.5;
  return camera;
}

/// Returns where an operator may have come back to, seen from a known pose: beside, before and
/// behind it, looking elsewhere; or around what was looked at there, at `distance_m`.
std::vector<RigidTransform> MakeOffsets(double distance_m) {
  const auto rotation = [](double yaw_deg, double pitch_deg) -> Eigen::Quaterniond {
    return Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(pitch_deg * kRadPerDeg, Eigen::Vector3d::UnitX());
  };
  // With rotations of 12 degrees this covers 15 cm and 20 degrees around a known pose, as Improve()
  // and the refinement bridge half a step. Larger: they cannot; smaller: less is covered. Not
  // tuned.
  constexpr double kStep_m = 0.09;
  std::vector<Eigen::Vector3d> shifts = {Eigen::Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-kStep_m, kStep_m})
      shifts.emplace_back(step * Eigen::Vector3d::Unit(axis));
  }
  std::vector<RigidTransform> offsets;
  for (const Eigen::Vector3d& shift : shifts) {
    for (const double yaw : {-12.0, 0.0, 12.0}) {
      for (const double pitch : {-12.0, 0.0, 12.0})
        offsets.push_back(MakeTransform(shift, rotation(yaw, pitch)));
    }
  }
  for (const double yaw : {-36.0, -18.0, 0.0, 18.0, 36.0}) {
    for (const double pitch : {-24.0, 0.0, 24.0}) {
      for (const double farther : {-0.25, 0.0, 0.35}) {
        const RigidTransform orbit =
            MakeTransform({0.0, 0.0, distance_m}, rotation(yaw, pitch)) *
            MakeTransform({0.0, 0.0, -(1.0 + farther) * distance_m}, rotation(0.0, 0.0));
        offsets.push_back(orbit);
      }
    }
  }
  return offsets;
}

/// Median of what is seen; 0 = nothing.
double MedianDepth(const Thumbnail& image) {
  std::vector<float> seen;
  for (const float z : image.depth_m) {
    if (z > 0.0F) seen.push_back(z);
  }
  if (seen.empty()) return 0.0;
  return static_cast<double>(TakeMedian(seen));
}

/// The best, best first, none near another.
std::vector<PoseGuess> ChooseDistinct(std::vector<PoseGuess> guesses, std::size_t count) {
  std::sort(guesses.begin(), guesses.end(),
            [](const PoseGuess& a, const PoseGuess& b) { return a.disagreement < b.disagreement; });
  std::vector<PoseGuess> best;
  for (const PoseGuess& guess : guesses) {
    // Most cells disagree: views of another place. Smaller: a right guess that the model knows only
    // half of is dropped; larger: tries are spent on other places. Not tuned.
    constexpr float kHopeless = 0.7F;
    if (guess.disagreement > kHopeless || best.size() == count) break;
    const bool known = std::any_of(best.begin(), best.end(), [&](const PoseGuess& other) {
      return IsNear(other.T_map_depth, guess.T_map_depth, kSameGuess_m, kSameGuess_rad);
    });
    if (!known) best.push_back(guess);
  }
  return best;
}

constexpr int kCellSide = kBlockSide / 2;  ///< Voxels that make a point of the cloud.
// Few voxels of a block are near the surface: tasks of this size outweigh handing them out. Not
// tuned.
constexpr std::int32_t kBlocksPerTask = 256;

/// Adds the mean of the voxels near the surface in each eighth of a block. Coarse on purpose: a
/// thumbnail's cell covers centimetres.
void AddSurfacePoints(const TsdfVolume& volume, std::int32_t block,
                      std::vector<Eigen::Vector3f>& points) {
  const VoxelGrid& grid = volume.grid();
  // Within about a voxel of the surface, and seen at least once at full weight.
  const auto near = static_cast<float>(1.1 * grid.voxel_size_m / volume.truncation_distance_m());
  std::array<Eigen::Vector3i, 8> sums;
  sums.fill(Eigen::Vector3i::Zero());
  std::array<int, 8> counts{};
  const auto voxels = volume.voxels(block);
  std::size_t i = 0;
  for (int z = 0; z < kBlockSide; ++z) {
    for (int y = 0; y < kBlockSide; ++y) {
      for (int x = 0; x < kBlockSide; ++x, ++i) {
        if (std::abs(voxels[i].tsdf()) > near || voxels[i].weight() < 1.0F) continue;
        const auto k =
            static_cast<std::size_t>(x / kCellSide + 2 * (y / kCellSide) + 4 * (z / kCellSide));
        sums[k] += Eigen::Vector3i(x, y, z);
        ++counts[k];
      }
    }
  }
  const Eigen::Vector3d first = grid.VoxelCentre(volume.block_coordinates(block) * kBlockSide);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    const Eigen::Vector3d mean = sums[k].cast<double>() / counts[k];
    points.push_back((first + grid.voxel_size_m * mean).cast<float>());
  }
}

/// The first point in each cell of a grid.
std::vector<Eigen::Vector3f> OnePerCell(const std::vector<Eigen::Vector3f>& points,
                                        const Eigen::Vector3f& origin, float cells_per_metre) {
  // Three axes in 64 bits.
  constexpr int kBits = 21;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float cell = std::max(0.0F, (points[i][axis] - origin[axis]) * cells_per_metre);
      key = (key << kBits) | static_cast<std::uint64_t>(cell);
    }
    keys.emplace_back(key, static_cast<std::uint32_t>(i));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Eigen::Vector3f> kept;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i].first != keys[i - 1].first) kept.push_back(points[keys[i].second]);
  }
  return kept;
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
        // A cell with fewer returns lies at an edge or in a shadow, where its mean would be of both
        // surfaces.
        thumbnail.depth_m[static_cast<std::size_t>(row * Thumbnail::kWidth + column)] =
            sum / static_cast<float>(count);
      }
    }
  }
  return thumbnail;
}

float Disagreement(const Thumbnail& image, const Thumbnail& expected) {
  constexpr float kFull_m = 0.08F;  // From this difference on, cells disagree fully.
  float sum = 0.0F;
  float weight = 0.0F;
  int both = 0;
  for (std::size_t i = 0; i < image.depth_m.size(); ++i) {
    const float a = image.depth_m[i];
    const float b = expected.depth_m[i];
    if (a > 0.0F && b > 0.0F) {
      sum += std::min(1.0F, std::abs(a - b) / kFull_m);
      weight += 1.0F;
      ++both;
    } else if (a > 0.0F) {
      // The model may not know this place yet. It counts half, or guesses on unknown ground would
      // win by seeing nothing.
      sum += 0.5F;
      weight += 1.0F;
    }
  }
  // Of 300 cells: a smaller overlap may agree by chance. Not tuned.
  constexpr int kMinCells = 40;
  return both < kMinCells ? 1.0F : sum / weight;
}

std::vector<Eigen::Vector3f> MakeSurfaceCloud(const TsdfVolume& volume, std::size_t max_points,
                                              ThreadPool& pool) {
  std::vector<std::vector<Eigen::Vector3f>> by_task(
      static_cast<std::size_t>((volume.block_count() + kBlocksPerTask - 1) / kBlocksPerTask));
  pool.ParallelFor(static_cast<int>(by_task.size()), [&](int task) {
    const std::int32_t end = std::min(volume.block_count(), (task + 1) * kBlocksPerTask);
    for (std::int32_t block = task * kBlocksPerTask; block < end; ++block) {
      if (volume.may_end_rays(block))
        AddSurfacePoints(volume, block, by_task[static_cast<std::size_t>(task)]);
    }
  });
  std::vector<Eigen::Vector3f> points;
  for (const auto& part : by_task) points.insert(points.end(), part.begin(), part.end());
  // Thinned out evenly: one point per cell of a grid that gets coarser until it is enough.
  const VoxelGrid& grid = volume.grid();
  for (double spacing = kCellSide * grid.voxel_size_m; points.size() > max_points;) {
    spacing *= std::max(
        1.2, std::sqrt(static_cast<double>(points.size()) / static_cast<double>(max_points)));
    points = OnePerCell(points, grid.min_m.cast<float>(), static_cast<float>(1.0 / spacing));
  }
  return points;
}

KeyframeDatabase::KeyframeDatabase(const CameraModel& depth_camera, int max_views)
    : camera_(ThumbnailCamera(depth_camera)), max_views_(static_cast<std::size_t>(max_views)) {}

void KeyframeDatabase::Add(const RigidTransform& T_map_depth) {
  if (poses_.size() >= max_views_) return;
  // The newest are the likeliest to be near.
  const bool known = std::any_of(poses_.rbegin(), poses_.rend(), [&](const RigidTransform& pose) {
    return IsNear(pose, T_map_depth, kNewView_m, kNewView_rad);
  });
  if (!known) poses_.push_back(T_map_depth);
}

void KeyframeDatabase::SetCloud(const std::vector<Eigen::Vector3f>& cloud) {
  cloud_.resize(static_cast<Eigen::Index>(cloud.size()), 3);
  for (Eigen::Index i = 0; i < cloud_.rows(); ++i)
    cloud_.row(i) = cloud[static_cast<std::size_t>(i)].transpose();
}

Thumbnail KeyframeDatabase::Look(const RigidTransform& T_map_depth) const {
  Thumbnail image;
  const Eigen::Matrix<float, 3, 4> T = T_map_depth.inverse().matrix().topRows<3>().cast<float>();
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx) + 0.5F;
  const auto cy = static_cast<float>(camera_.cy) + 0.5F;
  // No depth camera sees nearer, and a point at the camera would cover the whole image.
  constexpr float kNearest_m = 0.1F;
  constexpr Eigen::Index kChunk = 256;  // Stays in the nearest cache.
  using Column = Eigen::Array<float, Eigen::Dynamic, 1, 0, kChunk, 1>;
  for (Eigen::Index first = 0; first < cloud_.rows(); first += kChunk) {
    const Eigen::Index count = std::min(kChunk, cloud_.rows() - first);
    const auto along = [&](int row) -> Column {
      return T(row, 0) * cloud_.col(0).segment(first, count) +
             T(row, 1) * cloud_.col(1).segment(first, count) +
             T(row, 2) * cloud_.col(2).segment(first, count) + T(row, 3);
    };
    // Pixels of the thumbnail are found for a chunk at a time, in vectors; only the scatter below
    // is one by one.
    const Column z = along(2);
    const Column u = fx * along(0) / z + cx;
    const Column v = fy * along(1) / z + cy;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!(z(i) > kNearest_m && u(i) >= 0.0F && v(i) >= 0.0F &&
            u(i) < static_cast<float>(Thumbnail::kWidth) &&
            v(i) < static_cast<float>(Thumbnail::kHeight))) {
        continue;
      }
      float& cell = image.depth_m[static_cast<std::size_t>(
          static_cast<int>(v(i)) * Thumbnail::kWidth + static_cast<int>(u(i)))];
      // The cloud has points on surfaces that others hide; the nearest one in a cell is what a
      // camera sees.
      if (cell == 0.0F || z(i) < cell) cell = z(i);
    }
  }
  return image;
}

PoseGuess KeyframeDatabase::Improve(const Thumbnail& image, PoseGuess guess) const {
  // Steps of 4.5 cm and 7 degrees are halved up to three times, to a centimetre: nearer than what
  // the refinement needs to begin with. Not tuned.
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
        const RigidTransform pose = guess.T_map_depth * offset;
        const float disagreement = Disagreement(image, Look(pose));
        if (disagreement >= guess.disagreement) continue;
        guess = {pose, disagreement};
        better = true;
      }
    }
    // Steps are halved only when none of the twelve helps: coordinate descent, without derivatives,
    // which thumbnails of 20 x 15 depths do not have.
    if (better) continue;
    step_m *= 0.5;
    step_rad *= 0.5;
  }
  return guess;
}

std::vector<PoseGuess> KeyframeDatabase::Guess(const Thumbnail& image, int max_guesses,
                                               ThreadPool& pool) {
  const double distance_m = MedianDepth(image);
  if (poses_.empty() || cloud_.rows() == 0 || distance_m == 0.0) return {};
  const std::vector<RigidTransform> offsets = MakeOffsets(distance_m);
  const std::size_t count = std::min(poses_.size(), kPosesPerCall);
  const std::size_t apart = (poses_.size() + count - 1) / count;
  std::vector<PoseGuess> all(count * offsets.size());
  pool.ParallelFor(static_cast<int>(all.size()), [&](int task) {
    const auto i = static_cast<std::size_t>(task);
    // Far apart along the way, so that each call looks everywhere a little.
    const RigidTransform& pose = poses_[(next_pose_ + i / offsets.size() * apart) % poses_.size()];
    const RigidTransform guess = pose * offsets[i % offsets.size()];
    all[i] = {guess, Disagreement(image, Look(guess))};
  });
  // Consecutive calls interleave: after `apart` calls every known pose was looked from.
  next_pose_ = (next_pose_ + 1) % apart;
  // The refinement takes three of them by default (relocaliser.expert.guesses_per_frame). More:
  // slower; fewer: the right one may be missing. Not tuned.
  constexpr std::size_t kImproved = 8;
  // Improving first and choosing afterwards: a guess that begins second often ends first.
  std::vector<PoseGuess> best = ChooseDistinct(std::move(all), kImproved);
  pool.ParallelFor(static_cast<int>(best.size()), [&](int task) {
    PoseGuess& guess = best[static_cast<std::size_t>(task)];
    guess = Improve(image, guess);
  });
  return ChooseDistinct(std::move(best), static_cast<std::size_t>(max_guesses));
}

}  // namespace isotherm
