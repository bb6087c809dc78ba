#include "ground/camera_calibration/simulated_session.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "ground/camera_calibration/board_image.h"
#include "ground/camera_calibration/lens_rays.h"

namespace isotherm {
namespace {

template <typename T>
Image<float> AsFloat(const Image<T>& values) {
  Image<float> image(values.width(), values.height());
  for (std::size_t i = 0; i < values.size(); ++i)
    image.pixels()[i] = sizeof(T) == 2 && values.pixels()[i] == 0
                            ? std::nanf("")
                            : static_cast<float>(values.pixels()[i]);
  return image;
}

Image<float> TakeDepthImage(const TargetCamera& camera, const TargetSession& session,
                            const CalibrationTarget& target, const RigidTransform& pose,
                            std::uint64_t stream) {
  if (session.depth_images == TargetSession::DepthImages::kInfrared)
    return AsFloat(camera.Infrared(session.board, pose, stream));
  constexpr int kFrames = 8;
  std::vector<Image<float>> frames;
  for (std::uint64_t i = 0; i < kFrames; ++i)
    frames.push_back(AsFloat(camera.Depth(session.board, pose, MixBits(stream + i))));
  return BoardImage(frames, target);
}

}  // namespace

CameraModel ThesisThermal() {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = 371.4;
  camera.fy = 372.1;
  camera.cx = 205.5;
  camera.cy = 150.5;
  camera.k1 = -0.439;
  camera.k2 = 0.290;
  camera.p1 = 454e-6;
  camera.p2 = -257e-6;
  camera.k3 = -0.114;
  return camera;
}

CameraModel ThesisDepth() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 567.7;
  camera.cx = 321.3;
  camera.cy = 242.4;
  camera.k1 = -0.045;
  camera.k2 = 0.080;
  camera.p1 = -651e-6;
  camera.p2 = 2360e-6;
  camera.k3 = -0.109;
  return camera;
}

RigidTransform ThesisThermalFromDepth() {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(-0.1 * kRadPerDeg, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.4 * kRadPerDeg, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(-0.5 * kRadPerDeg, Eigen::Vector3d::UnitX()));
  return MakeTransform({0.0485, 0.0533, 0.0115}, rotation);
}

BundleCamera ToBundle(const CameraModel& camera) {
  return {camera.lens, ParametersOf(camera), RigidTransform::Identity()};
}

CalibrationInput TakeViews(const TargetSession& session, ThreadPool& pool) {
  // Poses that both cameras see, as for a rig, but of a wide lens, whose corners the depth camera
  // does not see.
  std::vector<TargetObserver> observers;
  if (session.depth || session.thermal_camera.lens == LensKind::kBrownConrady)
    observers.push_back({ThesisDepth()});
  observers.push_back({session.thermal_camera, ThesisThermalFromDepth()});
  const auto poses =
      SampleTargetViews(session.board, observers, session.count, session.views, session.seed);
  const TargetCamera depth(ThesisDepth(), session.cameras);
  const TargetCamera thermal(session.thermal_camera, session.cameras);
  CalibrationInput input;
  input.target = *ParseTarget("thesis-board");
  const auto add = [&](const char* name, LensKind lens) {
    input.camera_names.emplace_back(name);
    input.lenses.push_back(lens);
  };
  if (session.depth) add("depth", ThesisDepth().lens);
  if (session.thermal) add("thermal", session.thermal_camera.lens);
  input.views.resize(poses.size());
  pool.ParallelFor(static_cast<int>(poses.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    CalibrationView& view = input.views[index];
    view.name = fmt::format("view {}", i);
    constexpr std::uint64_t kDepth = 1, kThermal = 2;
    if (session.depth)
      view.images.push_back(TakeDepthImage(depth, session, input.target, poses[index],
                                           NoiseStream(session.seed, kDepth, index)));
    if (session.thermal)
      view.images.push_back(
          AsFloat(thermal.Thermal(session.board, ThesisThermalFromDepth() * poses[index],
                                  NoiseStream(session.seed, kThermal, index))));
  });
  return input;
}

PerforatedBoard WarpedBoard(double max_m, std::uint64_t seed) {
  constexpr std::uint64_t kPurpose = 0x77617270;
  const auto part = [&](std::uint64_t i) {
    return 2.0 * UniformNoise(NoiseStream(seed, kPurpose, i), 0) - 1.0;
  };
  PerforatedBoard board;
  const double bowl = part(0), twist = part(1), bend = 0.3 * part(2);
  const double sum = std::abs(bowl) + std::abs(twist) + std::abs(bend);
  board.bowl_m = max_m * bowl / sum;
  board.twist_m = max_m * twist / sum;
  board.s_bend_m = max_m * bend / sum;
  return board;
}

}  // namespace isotherm
