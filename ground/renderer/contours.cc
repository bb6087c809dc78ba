#include "ground/renderer/contours.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {
namespace {

// Neighbours this many voxels off each other's tangent plane are different surfaces: more than the
// step between neighbouring pixels at an edge that can be followed, less than what hides something.
constexpr double kSameSurfaceVox = 3.0;

Eigen::Vector3f PointAt(const SurfaceMaps& maps, int x, int y) {
  return {maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y)};
}

Eigen::Vector3f NormalAt(const SurfaceMaps& maps, int x, int y) {
  return {maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y)};
}

/// False where either has no surface.
bool SameSurface(const SurfaceMaps& maps, int x, int y, int x2, int y2, float tolerance_m) {
  const Eigen::Vector3f between = PointAt(maps, x2, y2) - PointAt(maps, x, y);
  return std::abs(between.dot(NormalAt(maps, x, y))) <= tolerance_m &&
         std::abs(between.dot(NormalAt(maps, x2, y2))) <= tolerance_m;
}

/// NaN if no voxel around was measured.
float InterpolateCelsius(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                         const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_voxel = tsdf.grid().ToVoxel(p_world);
  const Eigen::Vector3d lower = p_voxel.array().floor();
  const Eigen::Vector3d f = p_voxel - lower;
  double sum = 0.0, weights = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const GridIndex step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const GridIndex voxel = lower.cast<int>() + step;
    if ((voxel.array() < 0).any()) continue;
    const std::int32_t block = tsdf.Find(voxel / kBlockSide);
    if (block == TsdfVolume::kNoBlock) continue;
    const GridIndex local = voxel - voxel / kBlockSide * kBlockSide;
    const ThermalVoxel value = thermal.voxels(block)[static_cast<std::size_t>(
        local.x() + kBlockSide * (local.y() + kBlockSide * local.z()))];
    if (!value.measured()) continue;
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= step[axis] == 1 ? f[axis] : 1.0 - f[axis];
    sum += weight * static_cast<double>(value.celsius());
    weights += weight;
  }
  return weights > 0.0 ? static_cast<float>(sum / weights) : NAN;
}

/// Gaussian weights of a window, row-major.
class Window {
 public:
  explicit Window(double sigma_px)
      : radius_(static_cast<int>(std::ceil(2.5 * sigma_px))), side_(2 * radius_ + 1) {
    for (int y = -radius_; y <= radius_; ++y) {
      for (int x = -radius_; x <= radius_; ++x) {
        weights_.push_back(sigma_px > 0.0 ? std::exp(-(x * x + y * y) / (2.0 * sigma_px * sigma_px))
                                          : 1.0);
      }
    }
  }
  int radius() const { return radius_; }
  double weight(int x, int y) const {
    return weights_[static_cast<std::size_t>((y + radius_) * side_ + x + radius_)];
  }

 private:
  const int radius_;
  const int side_;
  std::vector<double> weights_;
};

/// Value at the pixel of the plane celsius = a + b dx + c dy that fits best around it.
float FitAt(const Image<float>& celsius, const SurfaceMaps& maps, const Window& window, int x,
            int y, float tolerance_m) {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  const double centre = celsius.At(x, y);
  for (int dy = -window.radius(); dy <= window.radius(); ++dy) {
    for (int dx = -window.radius(); dx <= window.radius(); ++dx) {
      if (!celsius.Contains(x + dx, y + dy)) continue;
      const double value = celsius.At(x + dx, y + dy);
      if (std::isnan(value) || !SameSurface(maps, x, y, x + dx, y + dy, tolerance_m)) continue;
      const Eigen::Vector3d basis(1.0, dx, dy);
      const double weight = window.weight(dx, dy);
      normal_matrix += weight * basis * basis.transpose();
      right_side += weight * (value - centre) * basis;
    }
  }
  // With fewer than three pixels, or pixels in a line, the plane is not determined.
  constexpr double kMinDeterminant = 1e-6;
  if (!(normal_matrix.determinant() > kMinDeterminant)) return celsius.At(x, y);
  return static_cast<float>(centre + normal_matrix.ldlt().solve(right_side).x());
}

/// A piece of a line, pixels.
struct Segment {
  Eigen::Vector2d from, to;
};

/// Adds where the line crosses the cell whose upper left corner is the pixel (x, y).
void AddCell(const ContourField& field, double level, int x, int y, std::vector<Segment>& out) {
  constexpr auto kBoth = ContourField::kRight | ContourField::kBelow;
  if ((field.joined.At(x, y) & kBoth) != kBoth ||
      (field.joined.At(x, y + 1) & ContourField::kRight) == 0 ||
      (field.joined.At(x + 1, y) & ContourField::kBelow) == 0) {
    return;
  }
  // Corners around the cell; edge i goes from corner i to the next.
  const std::array<Eigen::Vector2d, 4> corner = {Eigen::Vector2d(x, y), Eigen::Vector2d(x + 1, y),
                                                 Eigen::Vector2d(x + 1, y + 1),
                                                 Eigen::Vector2d(x, y + 1)};
  std::array<double, 4> above{};
  for (std::size_t i = 0; i < 4; ++i) {
    above[i] = static_cast<double>(field.celsius.At(static_cast<int>(corner[i].x()),
                                                    static_cast<int>(corner[i].y()))) -
               level;
    if (std::isnan(above[i])) return;
  }
  std::array<Eigen::Vector2d, 4> crossing;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    if ((above[i] > 0.0) == (above[next] > 0.0)) continue;
    crossing[count++] =
        corner[i] + above[i] / (above[i] - above[next]) * (corner[next] - corner[i]);
  }
  if (count == 2) out.push_back({crossing[0], crossing[1]});
  if (count != 4) return;
  // A saddle: the middle decides which corners hang together.
  const bool joins_first = (above[0] + above[1] + above[2] + above[3] > 0.0) == (above[0] > 0.0);
  const std::size_t shift = joins_first ? 0 : 1;
  out.push_back({crossing[shift], crossing[shift + 1]});
  out.push_back({crossing[shift + 2], crossing[(shift + 3) % 4]});
}

double DistanceTo(const Segment& segment, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = segment.to - segment.from;
  const double squared = along.squaredNorm();
  const double t =
      squared > 0.0 ? std::clamp((p - segment.from).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (segment.from + t * along - p).norm();
}

}  // namespace

ContourField SampleContours(const SurfaceMaps& maps, const TsdfVolume& tsdf,
                            const ThermalVolume& thermal, double smoothing_px,
                            ThreadPool& threads) {
  const int width = maps.width(), height = maps.height();
  const auto tolerance_m = static_cast<float>(kSameSurfaceVox * tsdf.grid().voxel_size_m);
  Image<float> sampled(width, height, NAN);
  ContourField field{Image<float>(width, height, NAN), Image<std::uint8_t>(width, height, 0)};
  threads.ParallelFor(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector3f p_world = PointAt(maps, x, y);
      if (!p_world.allFinite()) continue;
      sampled.At(x, y) = InterpolateCelsius(tsdf, thermal, p_world.cast<double>());
      if (x + 1 < width && SameSurface(maps, x, y, x + 1, y, tolerance_m))
        field.joined.At(x, y) |= ContourField::kRight;
      if (y + 1 < height && SameSurface(maps, x, y, x, y + 1, tolerance_m))
        field.joined.At(x, y) |= ContourField::kBelow;
    }
  });
  const Window window(smoothing_px);
  threads.ParallelFor(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      if (std::isnan(sampled.At(x, y))) continue;
      field.celsius.At(x, y) = FitAt(sampled, maps, window, x, y, tolerance_m);
    }
  });
  return field;
}

Image<float> IsothermCover(const ContourField& field, double celsius, double width_px) {
  const int width = field.celsius.width(), height = field.celsius.height();
  Image<float> cover(width, height, 0.0F);
  std::vector<Segment> segments;
  for (int y = 0; y + 1 < height; ++y) {
    for (int x = 0; x + 1 < width; ++x) AddCell(field, celsius, x, y, segments);
  }
  const double reach = width_px / 2.0 + 0.5;
  for (const Segment& segment : segments) {
    const Eigen::Vector2d low = segment.from.cwiseMin(segment.to).array() - reach;
    const Eigen::Vector2d high = segment.from.cwiseMax(segment.to).array() + reach;
    for (int y = static_cast<int>(std::ceil(low.y())); y <= std::floor(high.y()); ++y) {
      for (int x = static_cast<int>(std::ceil(low.x())); x <= std::floor(high.x()); ++x) {
        if (!cover.Contains(x, y)) continue;
        const double fraction =
            std::clamp(reach - DistanceTo(segment, {x, y}), 0.0, std::min(1.0, width_px));
        cover.At(x, y) = std::max(cover.At(x, y), static_cast<float>(fraction));
      }
    }
  }
  return cover;
}

}  // namespace isotherm
