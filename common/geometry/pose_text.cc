#include "common/geometry/pose_text.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

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

}  // namespace isotherm
