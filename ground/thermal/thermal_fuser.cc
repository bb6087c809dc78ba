#include "ground/thermal/thermal_fuser.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kFar = std::numeric_limits<float>::max();
constexpr int kRowsPerTask = 16;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

float CosineOfDegrees(double degrees) { return static_cast<float>(std::cos(degrees * kRadPerDeg)); }

/// Single-precision pinhole projection.
struct Projector {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  float fx, fy, cx, cy;
  int width, height;

  Projector(const CameraModel& c, const RigidTransform& T_camera_world)
      : R(T_camera_world.linear().cast<float>()),
        t(T_camera_world.translation().cast<float>()),
        fx(static_cast<float>(c.fx)),
        fy(static_cast<float>(c.fy)),
        cx(static_cast<float>(c.cx)),
        cy(static_cast<float>(c.cy)),
        width(c.width),
        height(c.height) {}

  /// Pixel coordinates; false behind the camera or outside the image.
  bool Project(const Eigen::Vector3f& p_world, float& u, float& v) const {
    const Eigen::Vector3f p = R * p_world + t;
    if (!(p.z() > 0.0F)) return false;
    u = fx * p.x() / p.z() + cx;
    v = fy * p.y() / p.z() + cy;
    return u >= 0.0F && v >= 0.0F && u <= static_cast<float>(width - 1) &&
           v <= static_cast<float>(height - 1);
  }
};

/// NaN if one of the four pixels around has no value. `u`, `v` inside the image.
float Bilinear(const Image<float>& image, float u, float v) {
  const int x = std::min(static_cast<int>(u), image.width() - 2);
  const int y = std::min(static_cast<int>(v), image.height() - 2);
  const float fx = u - static_cast<float>(x);
  const float fy = v - static_cast<float>(y);
  const float upper = image.At(x, y) + fx * (image.At(x + 1, y) - image.At(x, y));
  const float lower = image.At(x, y + 1) + fx * (image.At(x + 1, y + 1) - image.At(x, y + 1));
  return upper + fy * (lower - upper);
}

void MinimumAround(const Image<float>& in, int margin, Image<float>& out) {
  out.Resize(in.width(), in.height());
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) {
      float smallest = in.At(x, y);
      for (int v = std::max(0, y - margin); v <= std::min(in.height() - 1, y + margin); ++v) {
        for (int u = std::max(0, x - margin); u <= std::min(in.width() - 1, x + margin); ++u) {
          smallest = std::min(smallest, in.At(u, v));
        }
      }
      out.At(x, y) = smallest;
    }
  }
}

/// Smaller is better: good before acceptable.
int Rank(ConditionClass c) { return static_cast<int>(c); }

}  // namespace

Status Validate(const ThermalOptions& o) {
  if (!(o.distance_min_m() >= 0.0 && o.distance_min_m() < o.distance_good_m() &&
        o.distance_good_m() <= o.distance_max_m())) {
    return InvalidArgument(
        fmt::format("thermal: need 0 <= distance_min_m < distance_good_m <= distance_max_m, got {} "
                    "m, {} m, {} m",
                    o.distance_min_m(), o.distance_good_m(), o.distance_max_m()));
  }
  if (!(o.angle_min_deg() >= 0.0 && o.angle_min_deg() < o.angle_good_deg() &&
        o.angle_good_deg() <= o.angle_max_deg() && o.angle_max_deg() <= 90.0)) {
    return InvalidArgument(
        fmt::format("thermal: need 0 <= angle_min_deg < angle_good_deg <= angle_max_deg <= 90, got "
                    "{}, {}, {} degrees",
                    o.angle_min_deg(), o.angle_good_deg(), o.angle_max_deg()));
  }
  if (!(o.parallax_tolerance_m() > 0.0 && o.vertex_distance_vox() > 0.0 && o.max_wait_s() >= 0.0 &&
        o.max_wait_s() <= 10.0)) {
    return InvalidArgument(
        "thermal: parallax_tolerance_m and vertex_distance_vox must be positive, max_wait_s 0..10 "
        "s");
  }
  if (o.edge_margin_px() < 0 || o.edge_margin_px() > 16) {
    return InvalidArgument(
        fmt::format("thermal.edge_margin_px must be 0..16 pixels, got {}", o.edge_margin_px()));
  }
  return OkStatus();
}

ConditionLimits::ConditionLimits(const ThermalOptions& o)
    : distance_min_m(static_cast<float>(o.distance_min_m())),
      distance_good_m(static_cast<float>(o.distance_good_m())),
      distance_max_m(static_cast<float>(o.distance_max_m())),
      cosine_min_angle(CosineOfDegrees(o.angle_min_deg())),
      cosine_good_angle(CosineOfDegrees(o.angle_good_deg())),
      cosine_max_angle(CosineOfDegrees(o.angle_max_deg())) {}

ConditionClass ConditionLimits::ClassifyDistance(float d) const {
  if (!(d >= distance_min_m && d <= distance_max_m)) return ConditionClass::kBad;
  return d <= distance_good_m ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

ConditionClass ConditionLimits::ClassifyAngle(float cosine) const {
  if (!(cosine <= cosine_min_angle && cosine >= cosine_max_angle)) return ConditionClass::kBad;
  return cosine >= cosine_good_angle ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle, ThermalVoxel old) {
  const auto valid = [](ConditionClass distance, ConditionClass angle) {
    return distance != ConditionClass::kBad && angle != ConditionClass::kBad;
  };
  if (!old.measured() || !valid(old.distance_class(), old.angle_class())) return true;
  if (!valid(new_distance, new_angle)) return false;
  if (new_distance != old.distance_class()) return Rank(new_distance) < Rank(old.distance_class());
  return Rank(new_angle) <= Rank(old.angle_class());
}

ThermalRectifier::ThermalRectifier(const CameraModel& camera)
    : ideal_(camera.WithoutDistortion()),
      source_x_(camera.width, camera.height),
      source_y_(camera.width, camera.height) {
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d pixel = ProjectNormalized(camera, Unproject(ideal_, {u, v}));
      source_x_.At(u, v) = static_cast<float>(pixel.x());
      source_y_.At(u, v) = static_cast<float>(pixel.y());
    }
  }
}

void ThermalRectifier::Rectify(const Image<std::uint16_t>& centikelvin, ThreadPool& pool,
                               Image<float>& celsius) const {
  const int width = ideal_.width;
  const int height = ideal_.height;
  celsius.Resize(width, height);
  const auto value = [&](int x, int y) {
    const std::uint16_t raw = centikelvin.At(x, y);
    return raw == 0 ? kNan : CentikelvinToCelsius(raw);
  };
  pool.ParallelFor((height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(height, (task + 1) * kRowsPerTask);
    for (int v = task * kRowsPerTask; v < end; ++v) {
      for (int u = 0; u < width; ++u) {
        const float sx = source_x_.At(u, v);
        const float sy = source_y_.At(u, v);
        float result = kNan;
        if (sx >= 0.0F && sy >= 0.0F && sx < static_cast<float>(width - 1) &&
            sy < static_cast<float>(height - 1)) {
          const int x = static_cast<int>(sx);
          const int y = static_cast<int>(sy);
          const float fx = sx - static_cast<float>(x);
          const float fy = sy - static_cast<float>(y);
          const float upper = value(x, y) + fx * (value(x + 1, y) - value(x, y));
          const float lower = value(x, y + 1) + fx * (value(x + 1, y + 1) - value(x, y + 1));
          result = upper + fy * (lower - upper);
        }
        celsius.At(u, v) = result;
      }
    }
  });
}

ThermalFuser::ThermalFuser(const ThermalOptions& options, const CameraModel& thermal_camera)
    : options_(options), limits_(options), rectifier_(thermal_camera) {}

void ThermalFuser::MakeDistanceMap(const SurfaceMaps& view, const RigidTransform& T_thermal_world) {
  const CameraModel& camera = rectifier_.ideal_camera();
  nearest_m_.Resize(camera.width, camera.height);
  nearest_m_.Fill(kFar);
  const Projector thermal(camera, T_thermal_world);
  const Eigen::Vector3f position = T_thermal_world.inverse().translation().cast<float>();
  for (std::size_t i = 0; i < view.vx.size(); ++i) {
    const Eigen::Vector3f p(view.vx.data()[i], view.vy.data()[i], view.vz.data()[i]);
    float u = 0.0F;
    float v = 0.0F;
    if (!thermal.Project(p, u, v)) continue;  // Also refuses NaN.
    float& nearest = nearest_m_.At(static_cast<int>(u + 0.5F), static_cast<int>(v + 0.5F));
    nearest = std::min(nearest, (p - position).norm());
  }
  MinimumAround(nearest_m_, options_.edge_margin_px(), nearest_around_m_);
}

void ThermalFuser::SampleVertices(const SurfaceMaps& view, const RigidTransform& T_thermal_world,
                                  const Eigen::Vector3f& thermal_position, ThreadPool& pool) {
  vertex_celsius_.assign(view.vx.size(), kNan);
  vertex_classes_.assign(view.vx.size(), 0);
  const Projector thermal(rectifier_.ideal_camera(), T_thermal_world);
  const auto tolerance = static_cast<float>(options_.parallax_tolerance_m());
  const int width = view.width();
  std::atomic<std::int64_t> occluded{0};
  pool.ParallelFor((view.height() + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const auto begin = static_cast<std::size_t>(task * kRowsPerTask * width);
    const auto end =
        std::min(view.vx.size(), begin + static_cast<std::size_t>(kRowsPerTask * width));
    std::int64_t hidden = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f p(view.vx.data()[i], view.vy.data()[i], view.vz.data()[i]);
      float u = 0.0F;
      float v = 0.0F;
      if (!thermal.Project(p, u, v)) continue;
      const Eigen::Vector3f to_camera = thermal_position - p;
      const float distance = to_camera.norm();
      const Eigen::Vector3f n(view.nx.data()[i], view.ny.data()[i], view.nz.data()[i]);
      const float cosine = to_camera.dot(n) / distance;
      if (!(cosine > 0.0F)) continue;  // The camera is behind the surface.
      if (options_.parallax_filter()) {
        const float nearest =
            nearest_around_m_.At(static_cast<int>(u + 0.5F), static_cast<int>(v + 0.5F));
        // A slanted surface covers a range of distances within the margin.
        if (distance - nearest > tolerance) {
          ++hidden;
          continue;
        }
      }
      vertex_celsius_[i] = Bilinear(celsius_, u, v);
      vertex_classes_[i] = static_cast<std::uint8_t>(
          (static_cast<unsigned>(limits_.ClassifyDistance(distance)) << 4) |
          static_cast<unsigned>(limits_.ClassifyAngle(std::min(cosine, 1.0F))));
    }
    occluded += hidden;
  });
  occluded_ = occluded;
}

void ThermalFuser::SelectBlocks(const SurfaceMaps& view, const TsdfVolume& tsdf) {
  const VoxelGrid& grid = tsdf.grid();
  block_stamp_.resize(tsdf.table().size(), 0);
  ++stamp_;
  blocks_.clear();
  const auto inverse_voxel = static_cast<float>(1.0 / grid.voxel_size_m);
  const Eigen::Vector3f min = grid.min_m.cast<float>();
  const auto reach = static_cast<float>(options_.vertex_distance_vox());
  const auto visit = [&](const Eigen::Vector3f& p_vox) {
    const GridIndex block = (p_vox / static_cast<float>(kBlockSide)).array().floor().cast<int>();
    if (!tsdf.InGrid(block)) return;
    const std::int32_t index = tsdf.Find(block);
    if (index == TsdfVolume::kNoBlock || block_stamp_[index] == stamp_) return;
    block_stamp_[index] = stamp_;
    blocks_.push_back(index);
  };
  constexpr int kStride = 2;
  for (int y = 0; y < view.height(); y += kStride) {
    for (int x = 0; x < view.width(); x += kStride) {
      const Eigen::Vector3f p(view.vx.At(x, y), view.vy.At(x, y), view.vz.At(x, y));
      if (std::isnan(p.x())) continue;
      const Eigen::Vector3f p_vox = (p - min) * inverse_voxel;
      visit(p_vox);
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3f offset = Eigen::Vector3f::Zero();
        offset[axis] = reach;
        visit(p_vox + offset);
        visit(p_vox - offset);
      }
    }
  }
}

FusionReport ThermalFuser::Fuse(const ThermalFrame& frame, const RigidTransform& T_world_thermal,
                                const SurfaceMaps& view, const CameraModel& view_camera,
                                const RigidTransform& T_world_depth, const TsdfVolume& tsdf,
                                ThreadPool& pool, ThermalVolume& thermal) {
  const CameraModel& thermal_camera = rectifier_.ideal_camera();
  CHECK(frame.valid);
  CHECK(frame.centikelvin.width() == thermal_camera.width &&
        frame.centikelvin.height() == thermal_camera.height);
  const RigidTransform T_thermal_world = T_world_thermal.inverse();
  rectifier_.Rectify(frame.centikelvin, pool, celsius_);
  MakeDistanceMap(view, T_thermal_world);
  SampleVertices(view, T_thermal_world, T_world_thermal.translation().cast<float>(), pool);
  SelectBlocks(view, tsdf);

  const VoxelGrid& grid = tsdf.grid();
  const Projector depth(view_camera, T_world_depth.inverse());
  const auto voxel_m = static_cast<float>(grid.voxel_size_m);
  const auto max_distance = static_cast<float>(options_.vertex_distance_vox()) * voxel_m;
  const float max_tsdf =
      std::min(1.0F, 2.0F * max_distance / static_cast<float>(tsdf.truncation_distance_m()));
  const bool validate = options_.validation();
  std::atomic<std::int64_t> considered{0};
  std::atomic<std::int64_t> assigned{0};
  constexpr int kBlocksPerTask = 32;
  const int count = static_cast<int>(blocks_.size());
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    std::int64_t task_considered = 0;
    std::int64_t task_assigned = 0;
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int b = task * kBlocksPerTask; b < end; ++b) {
      const std::int32_t block = blocks_[b];
      const auto distances = tsdf.voxels(block);
      const auto temperatures = thermal.voxels(block);
      const Eigen::Vector3f first =
          grid.VoxelCentre(tsdf.block_coordinates(block) * kBlockSide).cast<float>();
      for (int i = 0; i < kBlockVoxels; ++i) {
        const TsdfVoxel voxel = distances[i];
        if (!voxel.observed() || std::abs(voxel.tsdf()) > max_tsdf) continue;
        const Eigen::Vector3f c =
            first + voxel_m * Eigen::Vector3f(static_cast<float>(i & 7),
                                              static_cast<float>((i >> 3) & 7),
                                              static_cast<float>(i >> 6));
        float u = 0.0F;
        float v = 0.0F;
        if (!depth.Project(c, u, v)) continue;
        const auto pixel = static_cast<std::size_t>(static_cast<int>(v + 0.5F) * view.width() +
                                                    static_cast<int>(u + 0.5F));
        const Eigen::Vector3f vertex(view.vx.data()[pixel], view.vy.data()[pixel],
                                     view.vz.data()[pixel]);
        if (!((c - vertex).squaredNorm() < max_distance * max_distance)) continue;
        ++task_considered;
        const float celsius = vertex_celsius_[pixel];
        if (std::isnan(celsius)) continue;
        const auto distance_class = static_cast<ConditionClass>(vertex_classes_[pixel] >> 4);
        const auto angle_class = static_cast<ConditionClass>(vertex_classes_[pixel] & 0xFU);
        if (validate && !ReplacesMeasurement(distance_class, angle_class, temperatures[i]))
          continue;
        temperatures[i] = ThermalVoxel::Make(celsius, distance_class, angle_class);
        ++task_assigned;
      }
    }
    considered += task_considered;
    assigned += task_assigned;
  });
  return {considered, occluded_, assigned};
}

}  // namespace isotherm
