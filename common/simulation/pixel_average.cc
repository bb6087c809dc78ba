#include "common/simulation/pixel_average.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr double kNegligible_k = 0.01;  // At 30 °C, a quarter of a good camera's noise.

double ApertureOf(const SimulatedLensOptions& lens) {
  return lens.focus_m() > 0.0 ? 1e-3 * lens.focal_length_mm() / lens.f_number() : 0.0;
}

/// The unit square onto a disc of radius 1, neighbours onto neighbours and area true (Shirley and
/// Chiu 1997).
Eigen::Vector2d ToDisc(const Eigen::Vector2d& in_square) {
  constexpr double kEighth_rad = std::numbers::pi / 4.0;
  const double x = 2.0 * in_square.x() - 1.0, y = 2.0 * in_square.y() - 1.0;
  if (x == 0.0 && y == 0.0) return Eigen::Vector2d::Zero();
  const bool along_x = std::abs(x) > std::abs(y);
  const double radius = along_x ? x : y;
  const double angle_rad = along_x ? kEighth_rad * y / x : kEighth_rad * (2.0 - x / y);
  return radius * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

/// Returns whether the next pixel on either side shows another part, or the radiance bends by more
/// than `limit`. `step` is the distance to the next pixel in the array.
bool IsUneven(const std::int16_t* primitive, const float* radiance, std::ptrdiff_t step,
              float limit) {
  return primitive[0] != primitive[step] || primitive[0] != primitive[-step] ||
         std::abs(radiance[step] + radiance[-step] - 2.0F * radiance[0]) > limit;
}

/// Returns whether a pixel that touches this one at a corner shows another part.
bool IsCorner(const Image<std::int16_t>& primitive, int x, int y) {
  if (x == 0 || y == 0 || x + 1 == primitive.width() || y + 1 == primitive.height()) return false;
  const std::int16_t own = primitive.At(x, y);
  return primitive.At(x - 1, y - 1) != own || primitive.At(x + 1, y - 1) != own ||
         primitive.At(x - 1, y + 1) != own || primitive.At(x + 1, y + 1) != own;
}

void MarkUneven(const HitImage& hits, const Image<float>& radiance, float limit,
                Image<std::uint8_t>& uneven) {
  const int width = radiance.width(), height = radiance.height();
  uneven.Resize(width, height);
  uneven.Fill(0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::int16_t* const primitive = &hits.primitive.At(x, y);
      const float* const value = &radiance.At(x, y);
      const bool along_row = x > 0 && x + 1 < width && IsUneven(primitive, value, 1, limit);
      const bool along_column = y > 0 && y + 1 < height && IsUneven(primitive, value, width, limit);
      uneven.At(x, y) = along_row || along_column || IsCorner(hits.primitive, x, y) ? 1 : 0;
    }
  }
}

/// Tiles of an image, the last ones cut off.
int TilesAcross(int pixels, int tile) { return (pixels + tile - 1) / tile; }

struct DepthRange {
  float nearest_m = std::numeric_limits<float>::infinity();
  float farthest_m = 0.0F;

  void Add(const DepthRange& other) {
    nearest_m = std::min(nearest_m, other.nearest_m);
    farthest_m = std::max(farthest_m, other.farthest_m);
  }
};

Image<DepthRange> DepthsOfTiles(const Image<float>& z_m) {
  Image<DepthRange> depths(TilesAcross(z_m.width(), RayGrid::kTileWidth),
                           TilesAcross(z_m.height(), RayGrid::kTileHeight));
  for (int y = 0; y < z_m.height(); ++y) {
    for (int x = 0; x < z_m.width(); ++x) {
      const float z = z_m.At(x, y);
      depths.At(x / RayGrid::kTileWidth, y / RayGrid::kTileHeight).Add({z, z});
    }
  }
  return depths;
}

DepthRange RangeAround(const Image<DepthRange>& depths, int x, int y) {
  DepthRange range;
  for (int v = std::max(0, y - 1); v <= std::min(depths.height() - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(depths.width() - 1, x + 1); ++u)
      range.Add(depths.At(u, v));
  }
  return range;
}

/// How far what a ray meets at this depth is from the ray, seen from elsewhere. In normalised image
/// coordinates.
double ShiftOf(const Eigen::Vector2f& ray, float z_m, const RigidTransform& T_moved_camera) {
  // Stands for infinity: from here on a shift of the camera moves nothing by a pixel.
  constexpr float kFarAway_m = 1e3F;
  const Eigen::Vector3d p_camera =
      static_cast<double>(std::min(z_m, kFarAway_m)) * ray.cast<double>().homogeneous();
  const Eigen::Vector3d p_moved = T_moved_camera * p_camera;
  if (p_moved.z() <= 0.0) return 0.0;
  return (p_moved.hnormalized() - ray.cast<double>()).norm();
}

/// Sums over all pixels above and to the left, one more row and column than the image has.
void SumUp(const Image<std::uint8_t>& uneven, Image<int>& sums) {
  sums.Resize(uneven.width() + 1, uneven.height() + 1);
  std::ranges::fill(sums.Row(0), 0);
  for (int y = 0; y < uneven.height(); ++y) {
    int in_row = 0;
    sums.At(0, y + 1) = 0;
    for (int x = 0; x < uneven.width(); ++x) {
      in_row += uneven.At(x, y);
      sums.At(x + 1, y + 1) = sums.At(x + 1, y) + in_row;
    }
  }
}

bool IsAnyWithin(const Image<int>& sums, int x, int y, int reach) {
  const int left = std::max(0, x - reach), right = std::min(sums.width() - 1, x + reach + 1);
  const int top = std::max(0, y - reach), bottom = std::min(sums.height() - 1, y + reach + 1);
  return sums.At(right, bottom) - sums.At(left, bottom) - sums.At(right, top) + sums.At(left, top) >
         0;
}

}  // namespace

PixelAverage::PixelAverage(const CameraModel& camera, const SimulatedThermalOptions& options)
    : focal_length_px_(std::max(camera.fx, camera.fy)),
      aperture_m_(ApertureOf(options.expert().lens())),
      focus_m_(options.expert().lens().focus_m()),
      negligible_(kNegligible_k * PlanckBandRadianceSlope(30.0, {options.expert().band_min_um(),
                                                                 options.expert().band_max_um()})) {
  // No two rays of a pixel share a row or a column, so that an edge along either shows in
  // side * side steps. Their cells of the lens are rows and columns of the pixel's diagonals, so
  // that each part of the lens sees all parts of the pixel.
  const int side = static_cast<int>(options.expert().rays_per_pixel_side());
  // Their ages go with the rows of the pixel, but not from one end to the other.
  const auto fine = [&](int cell, int within) { return (cell + (within + 0.5) / side) / side; };
  const std::vector<double> ages_s = Ages(options.expert().time_constant_s(), side * side);
  youngest_s_ = ages_s.front();
  oldest_s_ = ages_s.back();
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const Eigen::Vector2d in_pixel(fine(column, row), fine(row, column));
      const Eigen::Vector2d in_lens(fine((column + row) % side, row),
                                    fine((column - row + side) % side, column));
      const int age = (row + side / 2) % side * side + column;
      rays_.push_back({(in_pixel.array() - 0.5).cast<float>().matrix(),
                       0.5 * aperture_m_ * ToDisc(in_lens), ages_s[static_cast<std::size_t>(age)]});
      mean_m += rays_.back().lens_m / (side * side);
    }
  }
  for (Ray& ray : rays_) ray.lens_m -= mean_m;
}

std::vector<double> PixelAverage::Ages(double time_constant_s, int count) {
  // The exponential distribution cut into parts of equal weight, each at its median.
  std::vector<double> ages_s;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    ages_s.push_back(-time_constant_s * std::log(1.0 - (i + 0.5) / count));
    sum += ages_s.back();
  }
  for (double& age_s : ages_s) age_s -= sum / count;
  return ages_s;
}

double PixelAverage::BlurDiameterPx(double z_m) const {
  // The circle on the detector is f^2 |D - z| / (N (D - f) z) by (2.20), the image f D / (D - f)
  // behind the lens (2.19).
  if (aperture_m_ == 0.0) return 0.0;
  return focal_length_px_ * aperture_m_ * std::abs(1.0 / z_m - 1.0 / focus_m_);
}

void PixelAverage::Apply(const Exposure& exposure, const HitImage& hits, Image<float>& radiance,
                         Scratch& scratch) const {
  const auto& [scene, grid, band, emissivity, T_world_camera, strip_rows] = exposure;
  const double reach = FindReach(grid, T_world_camera, hits, scratch);
  // The mean of a radiance that bends by b per pixel^2 in both directions is b times this off.
  const double spread = 1.0 / 12.0 + 0.25 * reach * reach;
  MarkUneven(hits, radiance, static_cast<float>(negligible_ / spread), scratch.uneven);
  SumUp(scratch.uneven, scratch.uneven_sums);
  for (int first_row = 0; first_row < radiance.height(); first_row += strip_rows) {
    FindPixels(first_row, std::min(first_row + strip_rows, radiance.height()), scratch);
    const std::size_t count = scratch.pixels.size();
    if (count == 0) continue;
    scratch.rays.resize(count);
    scratch.hits.resize(count);
    scratch.sums.assign(count, 0.0);
    for (const Ray& ray : rays_) {
      const RigidTransform T_world_lens =
          T_world_camera(first_row, ray.age_s) *
          MakeTransform({ray.lens_m.x(), ray.lens_m.y(), 0.0}, Eigen::Quaterniond::Identity());
      for (std::size_t i = 0; i < count; ++i)
        scratch.rays[i] = RayThrough(grid, scratch.pixels[i], ray);
      CastRays(scene, scratch.rays, T_world_lens, scratch.hits);
      const RadianceView view(scene, band, emissivity, T_world_lens);
      for (std::size_t i = 0; i < count; ++i)
        scratch.sums[i] += view.At(scratch.hits[i].primitive, scratch.rays[i], scratch.hits[i].z_m);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2i& pixel = scratch.pixels[i];
      radiance.At(pixel.x(), pixel.y()) =
          static_cast<float>(scratch.sums[i] / static_cast<double>(rays_.size()));
    }
  }
}

int PixelAverage::FindReach(const RayGrid& grid, const PoseOfRows& T_world_camera,
                            const HitImage& hits, Scratch& scratch) const {
  // Rays begin anywhere in the pixel.
  constexpr double kPixelRadius_px = 0.5;
  const Image<DepthRange> depths = DepthsOfTiles(hits.z_m);
  const int middle = grid.height() / 2;
  const RigidTransform T_camera_world = T_world_camera(middle, 0.0).inverse();
  const RigidTransform T_young_camera =
      (T_camera_world * T_world_camera(middle, youngest_s_)).inverse();
  const RigidTransform T_old_camera =
      (T_camera_world * T_world_camera(middle, oldest_s_)).inverse();
  scratch.reach.Resize(depths.width(), depths.height());
  int largest = 0;
  for (int v = 0; v < depths.height(); ++v) {
    for (int u = 0; u < depths.width(); ++u) {
      const DepthRange range = RangeAround(depths, u, v);
      const Eigen::Vector2f ray = grid.Ray(
          std::min(u * RayGrid::kTileWidth + RayGrid::kTileWidth / 2, grid.width() - 1),
          std::min(v * RayGrid::kTileHeight + RayGrid::kTileHeight / 2, grid.height() - 1));
      double blur_px = 0.0, shift = 0.0;
      for (const float z_m : {range.nearest_m, range.farthest_m}) {
        blur_px = std::max(blur_px, 0.5 * BlurDiameterPx(static_cast<double>(z_m)));
        shift =
            std::max({shift, ShiftOf(ray, z_m, T_young_camera), ShiftOf(ray, z_m, T_old_camera)});
      }
      // What is uneven begins behind the middle of the nearest pixel that is.
      const double reach_px = kPixelRadius_px + blur_px + focal_length_px_ * shift;
      scratch.reach.At(u, v) = static_cast<int>(std::min(reach_px, 1e3));
      largest = std::max(largest, scratch.reach.At(u, v));
    }
  }
  return largest;
}

void PixelAverage::FindPixels(int first_row, int end_row, Scratch& scratch) {
  scratch.pixels.clear();
  // Tile by tile, so that the rays that are cast together stay close together.
  for (int y0 = first_row; y0 < end_row; y0 += RayGrid::kTileHeight) {
    for (int x0 = 0; x0 < scratch.uneven.width(); x0 += RayGrid::kTileWidth) {
      const int reach = scratch.reach.At(x0 / RayGrid::kTileWidth, y0 / RayGrid::kTileHeight);
      for (int y = y0; y < std::min(y0 + RayGrid::kTileHeight, end_row); ++y) {
        for (int x = x0; x < std::min(x0 + RayGrid::kTileWidth, scratch.uneven.width()); ++x) {
          if (IsAnyWithin(scratch.uneven_sums, x, y, reach)) scratch.pixels.emplace_back(x, y);
        }
      }
    }
  }
}

Eigen::Vector2f PixelAverage::RayThrough(const RayGrid& grid, const Eigen::Vector2i& pixel,
                                         const Ray& ray) const {
  const int x = std::clamp(pixel.x(), 1, grid.width() - 2);
  const int y = std::clamp(pixel.y(), 1, grid.height() - 2);
  const Eigen::Vector2f per_column = 0.5F * (grid.Ray(x + 1, y) - grid.Ray(x - 1, y));
  const Eigen::Vector2f per_row = 0.5F * (grid.Ray(x, y + 1) - grid.Ray(x, y - 1));
  const Eigen::Vector2f through_middle = grid.Ray(pixel.x(), pixel.y()) +
                                         ray.pixel_offset.x() * per_column +
                                         ray.pixel_offset.y() * per_row;
  if (aperture_m_ == 0.0) return through_middle;
  return through_middle - (ray.lens_m / focus_m_).cast<float>();
}

}  // namespace isotherm
