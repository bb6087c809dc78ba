#include "ground/initial_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace isotherm {

Result<RigidTransform> ParsePose(std::string_view text) {
  std::array<double, 7> values{};
  std::size_t count = 0;
  const char* place = text.data();
  const char* const end = text.data() + text.size();
  while (true) {
    while (place != end && (*place == ' ' || *place == '\t' || *place == ',')) ++place;
    if (place == end) break;
    double value = 0.0;
    const auto [next, error] = std::from_chars(place, end, value);
    if (error != std::errc() || !std::isfinite(value) || count == values.size()) {
      return Err(InvalidArgument(
          fmt::format("\"{}\" is not a pose: expected \"x y z qx qy qz qw\" in metres", text)));
    }
    values[count++] = value;
    place = next;
  }
  if (count != values.size()) {
    return Err(InvalidArgument(fmt::format(
        "\"{}\" has {} numbers: a pose has 7, \"x y z qx qy qz qw\" in metres", text, count)));
  }
  const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
  if (std::abs(rotation.norm() - 1.0) > 0.01) {
    return Err(InvalidArgument(fmt::format(
        "the quaternion of \"{}\" has length {:.4f} instead of 1", text, rotation.norm())));
  }
  return MakeTransform({values[0], values[1], values[2]}, rotation);
}

RigidTransform PoseFacingCentre(const VoxelGrid& grid, const Image<float>& depth_m) {
  std::vector<float> depths;
  for (const float z : depth_m.pixels()) {
    if (z > 0.0F) depths.push_back(z);
  }
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = 0.5 * (grid.min_m + grid.max_m());
  if (!depths.empty()) {
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    pose.translation().z() -= *middle;
  }
  return pose;
}

}  // namespace isotherm
