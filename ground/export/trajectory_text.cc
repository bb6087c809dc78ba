#include "ground/export/trajectory_text.h"

#include <fmt/format.h>

#include "common/base/output_file.h"
#include "common/base/units.h"

namespace isotherm {

std::string TumLine(const StampedPose& pose) {
  const std::int64_t ns = ToNanoseconds(pose.time);
  // Split by hand: a double has no room for today's date in nanoseconds.
  const std::string stamp =
      fmt::format("{}{}.{:09d}", ns < 0 ? "-" : "", std::abs(ns / kNanosecondsPerSecond),
                  std::abs(ns % kNanosecondsPerSecond));
  const Eigen::Vector3d t = pose.T_world_depth.translation();
  Eigen::Quaterniond q(pose.T_world_depth.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}", stamp, t.x(), t.y(),
                     t.z(), q.x(), q.y(), q.z(), q.w());
}

Status WriteTrajectory(std::span<const StampedPose> poses, const std::filesystem::path& path) {
  OutputFile file(path);
  file.Write("# T_world_depth: timestamp_s tx ty tz qx qy qz qw (metres, unit quaternion)\n");
  for (const StampedPose& pose : poses) file.Write(TumLine(pose) + "\n");
  return file.Commit();
}

}  // namespace isotherm
