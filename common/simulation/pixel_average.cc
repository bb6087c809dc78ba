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

/// Whether the next pixel in this direction shows another part, or the radiance bends by more than
/// `limit`. `step`: to the next pixel.
bool IsUneven(const std::int16_t* primitive, const float* radiance, std::ptrdiff_t step,
              float limit) {
  return primitive[0] != primitive[step] || primitive[0] != primitive[-step] ||
         std::abs(radiance[step] + radiance[-step] - 2.0F * radiance[0]) > limit;
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
      uneven.At(x, y) = along_row || along_column ? 1 : 0;
    }
  }
}

bool IsAnyWithin(const Image<std::uint8_t>& uneven, int x, int y, int reach) {
  const int first = std::max(0, x - reach), last = std::min(uneven.width() - 1, x + reach);
  for (int v = std::max(0, y - reach); v <= std::min(uneven.height() - 1, y + reach); ++v) {
    for (int u = first; u <= last; ++u) {
      if (uneven.At(u, v) != 0) return true;
    }
  }
  return false;
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
  const auto fine = [&](int cell, int within) { return (cell + (within + 0.5) / side) / side; };
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const Eigen::Vector2d in_pixel(fine(column, row), fine(row, column));
      const Eigen::Vector2d in_lens(fine((column + row) % side, row),
                                    fine((column - row + side) % side, column));
      rays_.push_back(
          {(in_pixel.array() - 0.5).cast<float>().matrix(), 0.5 * aperture_m_ * ToDisc(in_lens)});
      mean_m += rays_.back().lens_m / (side * side);
    }
  }
  for (Ray& ray : rays_) ray.lens_m -= mean_m;
}

double PixelAverage::BlurDiameterPx(double z_m) const {
  // The circle on the detector is f^2 |D - z| / (N (D - f) z) by (2.20), the image f D / (D - f)
  // behind the lens (2.19).
  if (aperture_m_ == 0.0) return 0.0;
  return focal_length_px_ * aperture_m_ * std::abs(1.0 / z_m - 1.0 / focus_m_);
}

void PixelAverage::Apply(const Scene& scene, const RayGrid& grid, const BandRadiance& band,
                         const EmissivityTables& emissivity, const RigidTransform& T_world_camera,
                         const HitImage& hits, Image<float>& radiance, Scratch& scratch) const {
  FindPixels(hits, radiance, scratch);
  const std::size_t count = scratch.pixels.size();
  scratch.rays.resize(count);
  scratch.hits.resize(count);
  scratch.sums.assign(count, 0.0);
  for (const Ray& ray : rays_) {
    const RigidTransform T_world_lens =
        T_world_camera *
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

void PixelAverage::FindPixels(const HitImage& hits, const Image<float>& radiance,
                              Scratch& scratch) const {
  float nearest_m = std::numeric_limits<float>::infinity(), farthest_m = 0.0F;
  for (const float z_m : hits.z_m.pixels()) {
    nearest_m = std::min(nearest_m, z_m);
    farthest_m = std::max(farthest_m, z_m);
  }
  const double blur_px = 0.5 * std::max(BlurDiameterPx(static_cast<double>(nearest_m)),
                                        BlurDiameterPx(static_cast<double>(farthest_m)));
  // The mean of a radiance that bends by b per pixel^2 in both directions is b times this off.
  const double spread = 1.0 / 12.0 + 0.25 * blur_px * blur_px;
  MarkUneven(hits, radiance, static_cast<float>(negligible_ / spread), scratch.uneven);
  const int reach = static_cast<int>(std::ceil(blur_px)) + 1;
  scratch.pixels.clear();
  // Tile by tile, so that the rays that are cast together stay close together.
  for (int y0 = 0; y0 < radiance.height(); y0 += RayGrid::kTileHeight) {
    for (int x0 = 0; x0 < radiance.width(); x0 += RayGrid::kTileWidth) {
      for (int y = y0; y < std::min(y0 + RayGrid::kTileHeight, radiance.height()); ++y) {
        for (int x = x0; x < std::min(x0 + RayGrid::kTileWidth, radiance.width()); ++x) {
          if (IsAnyWithin(scratch.uneven, x, y, reach)) scratch.pixels.emplace_back(x, y);
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
