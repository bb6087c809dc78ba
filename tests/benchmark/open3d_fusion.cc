#include "tests/benchmark/open3d_fusion.h"

#include <omp.h>
#include <open3d/t/pipelines/odometry/RGBDOdometry.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace isotherm {
namespace {

namespace core = open3d::core;
namespace odometry = open3d::t::pipelines::odometry;
using TensorImage = open3d::t::geometry::Image;
using open3d::t::geometry::VoxelBlockGrid;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The library's defaults for tracking a frame against the model.
constexpr std::array<int, 3> kIterations = {6, 3, 1};  // Coarse to fine.
constexpr float kOutlierDistance = 0.07F;
constexpr float kHuberDelta = 0.05F;
constexpr double kRelativeChange = 1e-6;
constexpr float kFullWeight = 3.0F;

/// Room for all blocks from the start, so that no frame pays for growing.
constexpr std::int64_t kBlocks = 100000;

const core::Device kCpu("CPU:0");

/// Adds the time from construction to destruction to a stage.
class Timer {
 public:
  explicit Timer(StageStats& stats) : stats_(stats) {}
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  ~Timer() {
    stats_.Add(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
                   .count());
  }

 private:
  StageStats& stats_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

core::Tensor ToTensor(const Eigen::Matrix4d& matrix) {
  core::Tensor tensor({4, 4}, core::Float64, kCpu);
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(tensor.GetDataPtr<double>()) = matrix;
  return tensor;
}

RigidTransform ToTransform(const core::Tensor& tensor) {
  const core::Tensor rows = tensor.Contiguous();
  RigidTransform transform = RigidTransform::Identity();
  transform.matrix() =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.GetDataPtr<double>());
  transform.linear() = Eigen::Quaterniond(transform.linear()).normalized().toRotationMatrix();
  return transform;
}

core::Tensor IntrinsicMatrix(const CameraModel& camera, double scale) {
  return core::Tensor::Init<double>({{camera.fx * scale, 0.0, camera.cx * scale},
                                     {0.0, camera.fy * scale, camera.cy * scale},
                                     {0.0, 0.0, 1.0}},
                                    kCpu);
}

/// A pixel without depth (NaN) makes those around it NaN, as in the library's filter.
TensorImage SmoothDepth(const TensorImage& depth_m) {
  const auto rows = static_cast<int>(depth_m.GetRows());
  const auto columns = static_cast<int>(depth_m.GetCols());
  const core::Tensor in = depth_m.AsTensor();
  core::Tensor out = core::Tensor::EmptyLike(in);
  const cv::Mat source(rows, columns, CV_32F, const_cast<void*>(in.GetDataPtr()));
  cv::Mat target(rows, columns, CV_32F, out.GetDataPtr());
  constexpr int kSide = 5;
  const cv::Mat mean(kSide, 1, CV_32F, cv::Scalar(1.0 / kSide));
  cv::sepFilter2D(source, target, CV_32F, mean, mean);
  return TensorImage(out);
}

bool HasConverged(const odometry::OdometryResult& before, const odometry::OdometryResult& now) {
  return std::abs(before.fitness_ - now.fitness_) < kRelativeChange * before.fitness_ &&
         std::abs(before.inlier_rmse_ - now.inlier_rmse_) < kRelativeChange * before.inlier_rmse_;
}

}  // namespace

Open3dFusion::Open3dFusion(const Options& options, const CameraModel& camera,
                           const RigidTransform& T_world_depth)
    : options_(options),
      width_(camera.width),
      height_(camera.height),
      truncation_vox_(
          static_cast<float>(options.truncation_distance_m / options.grid.voxel_size_m)),
      model_({"tsdf", "weight"}, {core::Float32, core::Float32},
             {core::SizeVector{1}, core::SizeVector{1}},
             static_cast<float>(options.grid.voxel_size_m), kBlockSide, kBlocks, kCpu),
      T_world_depth_(T_world_depth) {
  // The library takes all cores unless the variable is there, and then asks OpenMP.
  ::setenv("OMP_NUM_THREADS", std::to_string(options.threads).c_str(), 1);
  ::omp_set_num_threads(options.threads);
  for (int i = 0; i < kLevels; ++i)
    intrinsics_[i] = IntrinsicMatrix(camera, std::ldexp(1.0, i + 1 - kLevels));
}

core::Tensor Open3dFusion::WorldToCamera() const {
  return ToTensor(T_world_depth_.inverse().matrix());
}

Open3dFusion::Pyramid Open3dFusion::MakePyramid(const TensorImage& depth_raw,
                                                bool with_normals) const {
  Pyramid pyramid;
  TensorImage depth_m =
      depth_raw.ClipTransform(depth_scale_, static_cast<float>(options_.min_depth_m),
                              static_cast<float>(options_.max_depth_m), kNan);
  for (int i = kLevels - 1; i >= 0; --i) {
    pyramid[i].vertices = depth_m.CreateVertexMap(intrinsics_[i], kNan).AsTensor();
    if (with_normals) {
      pyramid[i].normals = SmoothDepth(depth_m)
                               .CreateVertexMap(intrinsics_[i], kNan)
                               .CreateNormalMap(kNan)
                               .AsTensor();
    }
    if (i > 0) depth_m = depth_m.PyrDownDepth(2.0F * kOutlierDistance, kNan);
  }
  return pyramid;
}

void Open3dFusion::Track(const TensorImage& depth_raw) {
  const Timer timer(times_.track);
  const Pyramid source = MakePyramid(depth_raw, false);
  const Pyramid target = MakePyramid(model_depth_, true);
  core::Tensor T_target_source = core::Tensor::Eye(4, core::Float64, kCpu);
  odometry::OdometryResult last(T_target_source, 0.0, 1.0);
  for (int i = 0; i < kLevels; ++i) {
    for (int iteration = 0; iteration < kIterations[i]; ++iteration) {
      const odometry::OdometryResult step = odometry::ComputeOdometryResultPointToPlane(
          source[i].vertices, target[i].vertices, target[i].normals, intrinsics_[i],
          T_target_source, kOutlierDistance, kHuberDelta);
      T_target_source = step.transformation_.Matmul(T_target_source);
      if (HasConverged(last, step)) break;
      last = step;
    }
  }
  T_world_depth_ = T_world_depth_ * ToTransform(T_target_source);
}

core::Tensor Open3dFusion::InsideVolume(const core::Tensor& blocks) const {
  const double block_m = options_.grid.block_size_m();
  const auto* coordinates = blocks.GetDataPtr<std::int32_t>();
  std::vector<std::int32_t> inside;
  for (std::int64_t i = 0; i < blocks.GetLength(); ++i) {
    const Eigen::Map<const Eigen::Vector3i> block(coordinates + 3 * i);
    const Eigen::Array3d min_m = block.cast<double>().array() * block_m;
    if ((min_m + block_m < options_.grid.min_m.array()).any() ||
        (min_m > options_.grid.max_m().array()).any()) {
      continue;
    }
    inside.insert(inside.end(), block.begin(), block.end());
  }
  const auto count = static_cast<std::int64_t>(inside.size() / 3);
  return core::Tensor(inside, {count, 3}, core::Int32, kCpu);
}

void Open3dFusion::Integrate(const TensorImage& depth_raw) {
  const core::Tensor extrinsics = WorldToCamera();
  const auto max_depth_m = static_cast<float>(options_.max_depth_m);
  const core::Tensor& intrinsics = intrinsics_.back();
  const Timer timer(times_.integrate);
  blocks_ = InsideVolume(model_.GetUniqueBlockCoordinates(
      depth_raw, intrinsics, extrinsics, depth_scale_, max_depth_m, truncation_vox_));
  model_.Integrate(blocks_, depth_raw, intrinsics, extrinsics, depth_scale_, max_depth_m,
                   truncation_vox_);
}

void Open3dFusion::CastModel() {
  const core::Tensor extrinsics = WorldToCamera();
  const float min_weight = std::min(static_cast<float>(trajectory_.size()), kFullWeight);
  const Timer timer(times_.raycast);
  auto maps = model_.RayCast(blocks_, intrinsics_.back(), extrinsics, width_, height_, {"depth"},
                             depth_scale_, static_cast<float>(options_.min_depth_m),
                             static_cast<float>(options_.max_depth_m), min_weight, truncation_vox_);
  model_depth_ = TensorImage(maps["depth"]);
}

void Open3dFusion::Process(const DepthFrame& frame) {
  depth_scale_ = static_cast<float>(frame.depth_scale);
  TensorImage depth_raw(height_, width_, 1, core::UInt16, kCpu);
  const std::span<const std::uint16_t> pixels = frame.depth_raw.pixels();
  std::copy(pixels.begin(), pixels.end(), static_cast<std::uint16_t*>(depth_raw.GetDataPtr()));
  const Timer timer(times_.frame);
  if (!trajectory_.empty()) {
    try {
      Track(depth_raw);
    } catch (const std::runtime_error&) {  // The library throws when its equations are singular.
      ++lost_;
    }
  }
  Integrate(depth_raw);
  CastModel();
  trajectory_.push_back({frame.header.capture_time, T_world_depth_});
}

}  // namespace isotherm
