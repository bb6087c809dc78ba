#include "ground/model/saved_rig.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {

void AddPose(const RigidTransform& pose, google::protobuf::RepeatedField<double>* out) {
  const Eigen::Quaterniond q(pose.linear());
  for (const double v : {pose.translation().x(), pose.translation().y(), pose.translation().z(),
                         q.x(), q.y(), q.z(), q.w()}) {
    out->Add(v);
  }
}

std::optional<RigidTransform> PoseAt(const google::protobuf::RepeatedField<double>& numbers,
                                     int first) {
  const auto at = [&](int i) { return numbers.Get(first + i); };
  const Eigen::Quaterniond q(at(6), at(3), at(4), at(5));
  const Eigen::Vector3d t(at(0), at(1), at(2));
  // A quaternion of doubles is off by rounding alone; more is a damaged file.
  constexpr double kUnitTolerance = 1e-3;
  if (!t.allFinite() || !(t.cwiseAbs().maxCoeff() <= kMaxCoordinate_m) ||
      !(std::abs(q.norm() - 1.0) < kUnitTolerance))
    return std::nullopt;
  return MakeTransform(t, q);
}

SavedCamera ToSaved(const CameraModel& camera) {
  SavedCamera saved;
  saved.set_width(camera.width);
  saved.set_height(camera.height);
  saved.set_fx(camera.fx);
  saved.set_fy(camera.fy);
  saved.set_cx(camera.cx);
  saved.set_cy(camera.cy);
  for (const double k : {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3})
    saved.add_distortion(k);
  if (camera.lens == LensKind::kBrownConrady) return saved;
  for (const double k : {camera.k4, camera.k5, camera.k6}) saved.add_distortion(k);
  saved.set_lens(static_cast<int>(camera.lens));
  return saved;
}

std::optional<CameraModel> FromSaved(const SavedCamera& saved) {
  if (!saved.has_width()) return std::nullopt;
  // Not by a cast alone, which takes 256 for 0; Validate refuses what is none.
  constexpr int kNone = static_cast<int>(kLastLensKind) + 1;
  const int lens = saved.lens() >= 0 && saved.lens() < kNone ? saved.lens() : kNone;
  CameraModel camera{saved.width(), saved.height(), saved.fx(), saved.fy(), saved.cx(), saved.cy()};
  const auto k = [&](int i) { return i < saved.distortion_size() ? saved.distortion(i) : 0.0; };
  camera.k1 = k(0);
  camera.k2 = k(1);
  camera.p1 = k(2);
  camera.p2 = k(3);
  camera.k3 = k(4);
  camera.k4 = k(5);
  camera.k5 = k(6);
  camera.k6 = k(7);
  camera.lens = static_cast<LensKind>(lens);
  return camera;
}

std::string Difference(const char* name, const SavedCamera& saved,
                       const std::optional<CameraModel>& camera) {
  if (!camera) return saved.has_width() ? fmt::format("it has no {} camera", name) : "";
  const SavedCamera now = ToSaved(*camera);
  if (now.SerializeAsString() == saved.SerializeAsString()) return "";
  return fmt::format(
      "its {} camera has {} x {} px, fx {:.2f} px, the model's {} x {} px, fx {:.2f} px", name,
      now.width(), now.height(), now.fx(), saved.width(), saved.height(), saved.fx());
}

}  // namespace isotherm
