#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/simulation/scene.h"

namespace isotherm {

/// Holds what each pixel of a camera sees.
struct HitImage {
  Image<float>
      z_m;  ///< height x width, row-major, metres along the optical axis; infinity = nothing.
  Image<std::int16_t> primitive;  ///< Index into Scene::primitives(); -1 = nothing.
};

/// The line of sight of every pixel of one camera, lens distortion included, in tiles. Built once.
/// Thread-safe (immutable).
class RayGrid {
 public:
  /// Primitives that a tile cannot meet are skipped for all of its rays. Larger: fewer are skipped;
  /// smaller: more of that test. Not tuned.
  static constexpr int kTileWidth = 32;
  static constexpr int kTileHeight = 8;
  static constexpr int kTilePixels = kTileWidth * kTileHeight;

  /// kTileHeight rows of kTileWidth rays (x, y, 1) in the camera's coordinates. Tiles at the right
  /// and lower border repeat the last pixel.
  struct Tile {
    /// Sets the bounds from the rays.
    void SetBounds();

    int x0 = 0, y0 = 0;  ///< First pixel.
    float min_x = 0, max_x = 0, min_y = 0, max_y = 0;
    float ray_x[kTilePixels];
    float ray_y[kTilePixels];
  };

  explicit RayGrid(const CameraModel& camera);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<Tile>& tiles() const { return tiles_; }
  /// Normalised image coordinates of a pixel.
  Eigen::Vector2f Ray(int x, int y) const { return {rays_x_.At(x, y), rays_y_.At(x, y)}; }

 private:
  int width_;
  int height_;
  Image<float> rays_x_, rays_y_;
  std::vector<Tile> tiles_;
};

/// Finds what each pixel sees from `T_world_camera`. Distances are exact up to float rounding (a
/// micrometre).
void CastRays(const Scene& scene, const RayGrid& grid, const RigidTransform& T_world_camera,
              HitImage& hits);

/// The same of a camera that moves while it reads one row after the other: `T_world_camera` is
/// asked once per kTileHeight rows, for the first of them.
void CastRays(const Scene& scene, const RayGrid& grid,
              const std::function<RigidTransform(int row)>& T_world_camera, HitImage& hits);

/// Holds what a single ray meets.
struct RayHit {
  float z_m;               ///< Metres along the optical axis; infinity = nothing.
  std::int16_t primitive;  ///< Index into Scene::primitives(); -1 = nothing.
};

/// The same for single rays (x, y, 1) in the camera's coordinates, as many as there are `hits`.
/// Faster if neighbours in the list are close together.
void CastRays(const Scene& scene, std::span<const Eigen::Vector2f> rays,
              const RigidTransform& T_world_camera, std::span<RayHit> hits);

/// The scene's primitives as seen from one camera pose, for what comes after CastRays. Thread-safe
/// (immutable).
class CameraView {
 public:
  CameraView(const Scene& scene, const RigidTransform& T_world_camera);

  /// Holds what a sensor needs to know of the surface that a ray met.
  struct Surface {
    float cosine;   ///< Cosine of the angle between normal and line of sight, 0..1.
    float celsius;  ///< True temperature.
  };
  /// The surface at the point at depth `z_m` on the line of sight (x, y, 1).
  Surface At(int primitive, const Eigen::Vector2f& ray, float z_m) const;
  float CosineAt(int primitive, const Eigen::Vector2f& ray, float z_m) const;

 private:
  /// Holds a primitive and the camera in its coordinates.
  struct Local {
    const Primitive* primitive;
    Eigen::Matrix3f R_primitive_camera;
    Eigen::Vector3f camera_in_primitive;
  };
  /// A point on the line of sight, in the primitive's coordinates.
  struct Point {
    Eigen::Vector3f direction;  ///< Direction of the line of sight.
    Eigen::Vector3d p_primitive;
  };
  static Point PointAt(const Local& local, const Eigen::Vector2f& ray, float z_m);
  static float CosineOf(const Local& local, const Point& point);

  std::vector<Local> locals_;
};

}  // namespace isotherm
