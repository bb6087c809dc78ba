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

constexpr std::size_t kViewsPerCall = 12;

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

/// Where an operator may have come back to: beside, before and behind a view, looking elsewhere.
std::vector<RigidTransform> MakeOffsets() {
  constexpr double kStepM = 0.09;
  constexpr double kStepRad = 12.0 * kRadPerDeg;
  std::vector<Eigen::Vector3d> shifts = {Eigen::Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-kStepM, kStepM})
      shifts.emplace_back(step * Eigen::Vector3d::Unit(axis));
  }
  std::vector<RigidTransform> offsets;
  for (const Eigen::Vector3d& shift : shifts) {
    for (int yaw = -1; yaw <= 1; ++yaw) {
      for (int pitch = -1; pitch <= 1; ++pitch) {
        const Eigen::Quaterniond turn =
            Eigen::AngleAxisd(kStepRad * yaw, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(kStepRad * pitch, Eigen::Vector3d::UnitX());
        offsets.push_back(MakeTransform(shift, turn));
      }
    }
  }
  return offsets;
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

ViewLibrary::ViewLibrary(const CameraModel& depth_camera, int max_views)
    : camera_(ThumbnailCamera(depth_camera)),
      max_views_(static_cast<std::size_t>(max_views)),
      offsets_(MakeOffsets()) {}

void ViewLibrary::Add(const SurfaceMaps& maps, const RigidTransform& T_world_depth) {
  if (views_.size() >= max_views_) return;
  // The newest views are the likeliest to be near.
  const bool known = std::any_of(views_.rbegin(), views_.rend(), [&](const KnownView& view) {
    return IsNear(view.T_world_depth, T_world_depth, kNewViewM, kNewViewRad);
  });
  if (known) return;
  KnownView view;
  view.T_world_depth = T_world_depth;
  const int step = std::max(1, maps.width() / (2 * Thumbnail::kWidth));
  for (int y = step / 2; y < maps.height(); y += step) {
    for (int x = step / 2; x < maps.width(); x += step) {
      const float z = maps.vz.At(x, y);
      if (z > 0.0F) view.points.emplace_back(maps.vx.At(x, y), maps.vy.At(x, y), z);
    }
  }
  views_.push_back(std::move(view));
}

Thumbnail ViewLibrary::Look(const KnownView& view, const RigidTransform& T_look_view) const {
  Thumbnail picture;
  const Eigen::Matrix<float, 3, 4> T = T_look_view.matrix().topRows<3>().cast<float>();
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx) + 0.5F;
  const auto cy = static_cast<float>(camera_.cy) + 0.5F;
  constexpr float kNearestM = 0.1F;
  for (const Eigen::Vector3f& p : view.points) {
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

PoseGuess ViewLibrary::Improve(const Thumbnail& picture, const KnownView& view,
                               PoseGuess guess) const {
  constexpr int kRounds = 4;
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
        const float disagreement =
            Disagreement(picture, Look(view, pose.inverse() * view.T_world_depth));
        if (disagreement >= guess.disagreement) continue;
        guess = {pose, disagreement, guess.view};
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
  if (views_.empty()) return {};
  const std::size_t count = std::min(views_.size(), kViewsPerCall);
  std::vector<PoseGuess> all(count * offsets_.size());
  pool.ParallelFor(static_cast<int>(count), [&](int task) {
    const auto i = static_cast<std::size_t>(task);
    const std::size_t index = (next_view_ + i) % views_.size();
    const KnownView& view = views_[index];
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      all[i * offsets_.size() + k] = {view.T_world_depth * offsets_[k],
                                      Disagreement(picture, Look(view, offsets_[k].inverse())),
                                      index};
    }
  });
  next_view_ = (next_view_ + count) % views_.size();
  constexpr std::size_t kImproved = 16;
  std::vector<PoseGuess> best = ChooseDistinct(std::move(all), kImproved);
  pool.ParallelFor(static_cast<int>(best.size()), [&](int task) {
    PoseGuess& guess = best[static_cast<std::size_t>(task)];
    guess = Improve(picture, views_[guess.view], guess);
  });
  return ChooseDistinct(std::move(best), static_cast<std::size_t>(max_guesses));
}

}  // namespace isotherm
