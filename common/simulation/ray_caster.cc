#include "common/simulation/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/simulation/trace_tile_kernel.h"

namespace isotherm {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A primitive as one camera sees it, with the bounds that spare most intersections.
struct SeenPrimitive {
  Shape shape = Shape::kBox;
  TileTarget target;
  float min_z = 0.0F;  ///< Nearest depth of the bounding box.
  float min_x = -kInfinity, max_x = kInfinity, min_y = -kInfinity, max_y = kInfinity;
};

/// Bounds in normalised image coordinates; unbounded if the box reaches behind the camera.
void SetBounds(const Primitive& primitive, const RigidTransform& T_camera_primitive,
               SeenPrimitive& seen) {
  const Eigen::Vector3d half = HalfExtents(primitive);
  double min_z = HUGE_VAL;
  Eigen::Vector2d low(HUGE_VAL, HUGE_VAL), high(-HUGE_VAL, -HUGE_VAL);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
    const Eigen::Vector3d p_camera = T_camera_primitive * half.cwiseProduct(sign);
    min_z = std::min(min_z, p_camera.z());
    const Eigen::Vector2d normalized = p_camera.head<2>() / p_camera.z();
    low = low.cwiseMin(normalized);
    high = high.cwiseMax(normalized);
  }
  // Nearer corners have projections without bound, or are behind the camera: such a box may be
  // anywhere.
  constexpr double kNear_m = 0.01;
  constexpr double kMargin = 1e-5;  // Float rounding.
  seen.min_z = static_cast<float>(std::max(0.0, min_z - kMargin));
  if (min_z < kNear_m) return;
  seen.min_x = static_cast<float>(low.x() - kMargin);
  seen.min_y = static_cast<float>(low.y() - kMargin);
  seen.max_x = static_cast<float>(high.x() + kMargin);
  seen.max_y = static_cast<float>(high.y() + kMargin);
}

/// All primitives, nearest first.
std::vector<SeenPrimitive> LookAt(const Scene& scene, const RigidTransform& T_world_camera) {
  std::vector<SeenPrimitive> seen;
  for (std::size_t i = 0; i < scene.primitives().size(); ++i) {
    const Primitive& primitive = scene.primitives()[i];
    const RigidTransform T_camera_primitive =
        T_world_camera.inverse() * primitive.T_world_primitive;
    const RigidTransform T_primitive_camera = T_camera_primitive.inverse();
    SeenPrimitive one;
    one.shape = primitive.shape;
    one.target.index = static_cast<std::int32_t>(i);
    Eigen::Map<Eigen::Matrix3f>(one.target.R_primitive_camera) =
        T_primitive_camera.linear().cast<float>();
    Eigen::Map<Eigen::Vector3f>(one.target.camera_in_primitive) =
        T_primitive_camera.translation().cast<float>();
    Eigen::Map<Eigen::Vector3f>(one.target.size) = primitive.size.cast<float>();
    SetBounds(primitive, T_camera_primitive, one);
    seen.push_back(one);
  }
  // Stable, so that two primitives at the same depth are always met in the same order.
  std::stable_sort(seen.begin(), seen.end(),
                   [](const auto& a, const auto& b) { return a.min_z < b.min_z; });
  return seen;
}

bool Overlap(const SeenPrimitive& primitive, const RayGrid::Tile& tile) {
  return primitive.min_x <= tile.max_x && primitive.max_x >= tile.min_x &&
         primitive.min_y <= tile.max_y && primitive.max_y >= tile.min_y;
}

void StoreTile(const RayGrid::Tile& tile, const TileHits& hits, HitImage& image) {
  const int columns = std::min(RayGrid::kTileWidth, image.z_m.width() - tile.x0);
  const int rows = std::min(RayGrid::kTileHeight, image.z_m.height() - tile.y0);
  const auto x0 = static_cast<std::size_t>(tile.x0);
  for (int row = 0; row < rows; ++row) {
    const int first = row * RayGrid::kTileWidth;
    std::copy_n(hits.z + first, columns, image.z_m.Row(tile.y0 + row).begin() + tile.x0);
    std::int16_t* const indices = image.primitive.Row(tile.y0 + row).data() + x0;
    for (int column = 0; column < columns; ++column) {
      indices[column] = static_cast<std::int16_t>(hits.index[first + column]);
    }
  }
}

/// `seen` nearest first.
void CastTile(const std::vector<SeenPrimitive>& seen, const RayGrid::Tile& tile, TileHits& hits) {
  std::fill_n(hits.z, RayGrid::kTilePixels, kInfinity);
  std::fill_n(hits.index, RayGrid::kTilePixels, -1);
  float farthest = kInfinity;
  for (const SeenPrimitive& primitive : seen) {
    if (primitive.min_z > farthest) break;  // Sorted: all that follow are hidden.
    if (!Overlap(primitive, tile)) continue;
    TraceTile(primitive.shape, primitive.target, tile, hits);
    farthest = hits.farthest;
  }
}

}  // namespace

void RayGrid::Tile::SetBounds() {
  const auto x_range = std::minmax_element(ray_x, ray_x + kTilePixels);
  const auto y_range = std::minmax_element(ray_y, ray_y + kTilePixels);
  min_x = *x_range.first;
  max_x = *x_range.second;
  min_y = *y_range.first;
  max_y = *y_range.second;
}

RayGrid::RayGrid(const CameraModel& camera)
    : width_(camera.width),
      height_(camera.height),
      rays_x_(camera.width, camera.height),
      rays_y_(camera.width, camera.height) {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector2d ray = Unproject(camera, Eigen::Vector2d(x, y));
      rays_x_.At(x, y) = static_cast<float>(ray.x());
      rays_y_.At(x, y) = static_cast<float>(ray.y());
    }
  }
  for (int y0 = 0; y0 < height_; y0 += kTileHeight) {
    for (int x0 = 0; x0 < width_; x0 += kTileWidth) {
      Tile& tile = tiles_.emplace_back();
      tile.x0 = x0;
      tile.y0 = y0;
      for (int i = 0; i < kTilePixels; ++i) {
        // Tiles are whole, so that the kernel needs no tests at the border; the rays beyond it are
        // not stored.
        const int x = std::min(x0 + i % kTileWidth, width_ - 1);
        const int y = std::min(y0 + i / kTileWidth, height_ - 1);
        tile.ray_x[i] = rays_x_.At(x, y);
        tile.ray_y[i] = rays_y_.At(x, y);
      }
      tile.SetBounds();
    }
  }
}

void CastRays(const Scene& scene, const RayGrid& grid, const RigidTransform& T_world_camera,
              HitImage& hits) {
  hits.z_m.Resize(grid.width(), grid.height());
  hits.primitive.Resize(grid.width(), grid.height());
  const std::vector<SeenPrimitive> seen = LookAt(scene, T_world_camera);
  TileHits tile_hits;
  for (const RayGrid::Tile& tile : grid.tiles()) {
    CastTile(seen, tile, tile_hits);
    StoreTile(tile, tile_hits, hits);
  }
}

void CastRays(const Scene& scene, const RayGrid& grid,
              const std::function<RigidTransform(int row)>& T_world_camera, HitImage& hits) {
  hits.z_m.Resize(grid.width(), grid.height());
  hits.primitive.Resize(grid.width(), grid.height());
  std::vector<SeenPrimitive> seen;
  int row_of_pose = -1;
  TileHits tile_hits;
  for (const RayGrid::Tile& tile : grid.tiles()) {
    // Tiles go row by row: one pose serves all tiles of a row.
    if (tile.y0 != row_of_pose) {
      seen = LookAt(scene, T_world_camera(tile.y0));
      row_of_pose = tile.y0;
    }
    CastTile(seen, tile, tile_hits);
    StoreTile(tile, tile_hits, hits);
  }
}

void CastRays(const Scene& scene, std::span<const Eigen::Vector2f> rays,
              const RigidTransform& T_world_camera, std::span<RayHit> hits) {
  CHECK(rays.size() == hits.size());
  const std::vector<SeenPrimitive> seen = LookAt(scene, T_world_camera);
  RayGrid::Tile tile;
  TileHits tile_hits;
  for (std::size_t first = 0; first < rays.size(); first += RayGrid::kTilePixels) {
    const std::size_t count =
        std::min(rays.size() - first, static_cast<std::size_t>(RayGrid::kTilePixels));
    for (std::size_t i = 0; i < RayGrid::kTilePixels; ++i) {
      // The rest of the last tile repeats a ray: bounds stay tight.
      const Eigen::Vector2f& ray = rays[first + std::min(i, count - 1)];
      tile.ray_x[i] = ray.x();
      tile.ray_y[i] = ray.y();
    }
    tile.SetBounds();
    CastTile(seen, tile, tile_hits);
    for (std::size_t i = 0; i < count; ++i)
      hits[first + i] = {tile_hits.z[i], static_cast<std::int16_t>(tile_hits.index[i])};
  }
}

CameraView::CameraView(const Scene& scene, const RigidTransform& T_world_camera) {
  for (const Primitive& primitive : scene.primitives()) {
    const RigidTransform T_primitive_camera =
        primitive.T_world_primitive.inverse() * T_world_camera;
    locals_.push_back({&primitive, T_primitive_camera.linear().cast<float>(),
                       T_primitive_camera.translation().cast<float>()});
  }
}

CameraView::Point CameraView::PointAt(const Local& local, const Eigen::Vector2f& ray, float z_m) {
  // In coordinates: for each pixel, and sanitizers watch a vector's temporaries one by one.
  const auto& r = local.R_primitive_camera;
  const float x = ray.x(), y = ray.y();
  Point point;
  for (int row = 0; row < 3; ++row) {
    const float direction = r(row, 0) * x + r(row, 1) * y + r(row, 2);
    point.direction[row] = direction;
    point.p_primitive[row] = static_cast<double>(local.camera_in_primitive[row] + z_m * direction);
  }
  return point;
}

float CameraView::CosineOf(const Local& local, const Point& point) {
  const Eigen::Vector3d normal = NormalAt(*local.primitive, point.p_primitive);
  const Eigen::Vector3f& d = point.direction;
  const float along = static_cast<float>(normal[0]) * d[0] + static_cast<float>(normal[1]) * d[1] +
                      static_cast<float>(normal[2]) * d[2];
  const float length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return std::min(std::abs(along) / length, 1.0F);
}

CameraView::Surface CameraView::At(int primitive, const Eigen::Vector2f& ray, float z_m) const {
  const Local& local = locals_[static_cast<std::size_t>(primitive)];
  const Point point = PointAt(local, ray, z_m);
  return {CosineOf(local, point),
          static_cast<float>(local.primitive->temperature.CelsiusAt(point.p_primitive))};
}

float CameraView::CosineAt(int primitive, const Eigen::Vector2f& ray, float z_m) const {
  const Local& local = locals_[static_cast<std::size_t>(primitive)];
  return CosineOf(local, PointAt(local, ray, z_m));
}

}  // namespace isotherm
