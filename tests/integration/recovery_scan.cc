#include "tests/integration/recovery_scan.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/noise.h"
#include "common/simulation/options.h"
#include "common/simulation/simulation_options.pb.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm::testing {

RecoveryScan::RecoveryScan(Scene scene, std::uint64_t seed)
    : scene_(std::move(scene)), seed_(seed) {
  rig_.depth = DefaultSimulatedRig().depth->WithoutDistortion().Downscaled(1);
  VolumeOptions& volume = *options_.mutable_volume();
  volume.set_voxel_size_m(0.004);
  options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
  options_.set_threads(2);
  SimulatedDepthOptions camera;
  // Half the focal length: half the disparity noise and steps in pixels for the same in metres.
  camera.mutable_expert()->set_disparity_noise_px(0.5 * camera.expert().disparity_noise_px());
  camera.mutable_expert()->set_disparity_step_px(0.5 * camera.expert().disparity_step_px());
  sensor_ = std::make_unique<DepthSensor>(*rig_.depth, camera);
}

void RecoveryScan::Start(const RigidTransform& first_pose) {
  auto created = GroundPipeline::Create(options_, rig_, first_pose);
  CHECK(created.has_value());
  pipeline_ = std::move(*created);
}

CaptureTime RecoveryScan::next_time() const {
  return CaptureTime(FromSeconds(100.0 + static_cast<double>(frame_) / 30.0));
}

DepthFrame RecoveryScan::Render(const RigidTransform& pose) {
  DepthFrame frame;
  frame.header.frame_number = frame_;
  frame.header.capture_time = next_time();
  frame.depth_raw = sensor_->Render(scene_, pose, NoiseStream(seed_, 0, frame_), scratch_);
  ++frame_;
  return frame;
}

DepthReport RecoveryScan::Show(const RigidTransform& pose) {
  return pipeline_->ProcessDepth(Render(pose));
}

DepthReport RecoveryScan::ShowCovered() {
  DepthFrame frame = Render(RigidTransform::Identity());
  frame.depth_raw.Fill(0);
  return pipeline_->ProcessDepth(frame);
}

double RecoveryScan::PositionError(const RigidTransform& truth) const {
  return TranslationDistance(pipeline_->model().trajectory.poses().back().T_world_depth, truth);
}

RecoveryScan::ModelError RecoveryScan::CompareModel(
    const std::vector<RigidTransform>& poses) const {
  const CameraModel camera = rig_.depth->Downscaled(1);
  ThreadPool pool(2);
  SurfaceMaps maps;
  std::vector<double> errors;
  std::size_t visible = 0;
  for (const RigidTransform& pose : poses) {
    Raycaster().Cast(pipeline_->model().tsdf(), camera, pose, 1.0F, pool, maps);
    for (int v = 0; v < camera.height; v += 2) {
      for (int u = 0; u < camera.width; u += 2) {
        const Eigen::Vector2d xy = Unproject(camera, {u, v});
        const auto hit = scene_.Intersect(pose.translation(),
                                          pose.linear() * Eigen::Vector3d(xy.x(), xy.y(), 1));
        if (!hit) continue;
        ++visible;
        const Eigen::Vector3d p(maps.vx.At(u, v), maps.vy.At(u, v), maps.vz.At(u, v));
        if (!p.allFinite()) continue;
        errors.push_back(std::abs((pose.inverse() * p).z() - hit->distance));
      }
    }
  }
  ModelError result;
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  result.median_m = errors[errors.size() / 2];
  result.p95_m = errors[errors.size() * 95 / 100];
  result.covered = static_cast<double>(errors.size()) / static_cast<double>(visible);
  return result;
}

}  // namespace isotherm::testing
