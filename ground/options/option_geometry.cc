#include "ground/options/option_geometry.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

// Quaternions and axes are typed with two or three digits; what is further from unit length is a
// mistake rather than rounding.
constexpr double kUnitTolerance = 0.01;

Eigen::Vector3d ToVector(const PointOptions& point) {
  return {point.x_m(), point.y_m(), point.z_m()};
}

void SetPoint(const Eigen::Vector3d& vector, PointOptions& point) {
  point.set_x_m(vector.x());
  point.set_y_m(vector.y());
  point.set_z_m(vector.z());
}

}  // namespace

Result<RigidTransform> ToTransform(const PoseOptions& pose) {
  if (!pose.IsInitialized()) {
    return Err(InvalidArgument("a pose needs x_m, y_m, z_m, qx, qy, qz and qw; missing: " +
                               pose.InitializationErrorString()));
  }
  const Eigen::Vector3d translation_m(pose.x_m(), pose.y_m(), pose.z_m());
  const Eigen::Quaterniond rotation(pose.qw(), pose.qx(), pose.qy(), pose.qz());
  if (!translation_m.allFinite() || !rotation.coeffs().allFinite())
    return Err(InvalidArgument("a pose has finite numbers only"));
  if (std::abs(rotation.norm() - 1.0) > kUnitTolerance) {
    return Err(InvalidArgument(
        fmt::format("the quaternion qx qy qz qw has length {:.4f} instead of 1", rotation.norm())));
  }
  return MakeTransform(translation_m, rotation);
}

PoseOptions ToOptions(const RigidTransform& pose) {
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(pose.linear()));
  PoseOptions options;
  options.set_x_m(pose.translation().x());
  options.set_y_m(pose.translation().y());
  options.set_z_m(pose.translation().z());
  options.set_qx(rotation.x());
  options.set_qy(rotation.y());
  options.set_qz(rotation.z());
  options.set_qw(rotation.w());
  return options;
}

std::vector<std::string> InitialPoseArguments(const RigidTransform& pose) {
  const PoseOptions options = ToOptions(pose);
  std::vector<std::string> arguments;
  for (const auto& [name, value] :
       {std::pair("x_m", options.x_m()), std::pair("y_m", options.y_m()),
        std::pair("z_m", options.z_m()), std::pair("qx", options.qx()),
        std::pair("qy", options.qy()), std::pair("qz", options.qz()),
        std::pair("qw", options.qw())}) {
    arguments.emplace_back("--set");
    arguments.push_back(fmt::format("volume.expert.initial_pose.{}={}", name, value));
  }
  return arguments;
}

Result<Eigen::AlignedBox3d> ToBox(const BoxOptions& box) {
  const Eigen::Vector3d min_m = ToVector(box.min()), max_m = ToVector(box.max());
  if (box.IsInitialized() && min_m.allFinite() && max_m.allFinite() &&
      (min_m.array() < max_m.array()).all()) {
    return Eigen::AlignedBox3d(min_m, max_m);
  }
  return Err(InvalidArgument(fmt::format(
      "box must have two corners, min and max, with x_m, y_m and z_m each, and each number of max "
      "larger than that of min; got {} {} {} and {} {} {}",
      min_m.x(), min_m.y(), min_m.z(), max_m.x(), max_m.y(), max_m.z())));
}

BoxOptions ToOptions(const Eigen::AlignedBox3d& box) {
  BoxOptions options;
  SetPoint(box.min(), *options.mutable_min());
  SetPoint(box.max(), *options.mutable_max());
  return options;
}

}  // namespace isotherm
