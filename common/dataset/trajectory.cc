#include "common/dataset/trajectory.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "common/dataset/text_lines.h"

namespace isotherm {
namespace {

// Files carry six digits or more; anything further off is not a rotation.
constexpr double kQuaternionNormTolerance = 1e-2;

Result<RigidTransform> ParsePose(std::string_view rest) {
  std::array<double, 7> v{};
  for (double& number : v) {
    const std::string_view word = NextWord(rest);
    if (word.empty()) return Err(DataLoss("expected 8 columns: timestamp tx ty tz qx qy qz qw"));
    const Result<double> parsed = ParseNumber(word);
    if (!parsed) return Err(parsed.error());
    number = *parsed;
  }
  if (!rest.empty()) {
    return Err(DataLoss("more than the 8 columns timestamp tx ty tz qx qy qz qw"));
  }
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (std::abs(rotation.norm() - 1.0) > kQuaternionNormTolerance) {
    return Err(DataLoss(
        fmt::format("qx qy qz qw is no unit quaternion, its length is {:.6g}", rotation.norm())));
  }
  return MakeTransform({v[0], v[1], v[2]}, rotation);
}

}  // namespace

Result<std::vector<StampedPose>> ParseTrajectory(std::string_view text,
                                                 std::string_view source_name) {
  std::vector<StampedPose> poses;
  for (const TextLine& line : ContentLines(text)) {
    std::string_view rest = line.text;
    const Result<CaptureTime> time = ParseStamp(NextWord(rest));
    if (!time) return Err(time.error().WithContext(At(source_name, line)));
    Result<RigidTransform> pose = ParsePose(rest);
    if (!pose) return Err(pose.error().WithContext(At(source_name, line)));
    if (!poses.empty() && *time <= poses.back().time) {
      return Err(DataLoss(
          fmt::format("{}: timestamp {} is not later than the one before ({}); sort the lines by "
                      "time and remove duplicates",
                      At(source_name, line), FormatStamp(*time), FormatStamp(poses.back().time))));
    }
    poses.push_back({*time, *pose});
  }
  return poses;
}

Result<std::vector<StampedPose>> ReadTrajectory(const std::filesystem::path& path) {
  const Result<std::string> text = ReadTextFile(path);
  if (!text) return Err(text.error());
  Result<std::vector<StampedPose>> poses = ParseTrajectory(*text, path.string());
  if (poses && poses->empty()) {
    return Err(DataLoss(
        fmt::format("{}: has no poses (timestamp tx ty tz qx qy qz qw per line)", path.string())));
  }
  return poses;
}

}  // namespace isotherm
