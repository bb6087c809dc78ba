#include "ground/cli/scan_arguments.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <utility>

#include "common/geometry/pose_text.h"
#include "common/rig/rig_calibration.h"
#include "ground/cli/command.h"
#include "ground/cli/numbers.h"
#include "ground/evaluation/true_poses.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

GroundOptions CollectOptions(const ScanArguments& arguments, Problems& problems) {
  GroundOptions options;
  Apply(arguments.configuration, options, problems);
  VolumeOptions& volume = *options.mutable_volume();
  if (!arguments.volume.empty()) {
    if (const auto size = ParseNumbers(arguments.volume, {1, 3}, "--volume")) {
      volume.set_size_x_m(size->front());
      volume.set_size_y_m((*size)[size->size() / 2]);
      volume.set_size_z_m(size->back());
    } else {
      problems.Add(size.error());
    }
  }
  if (!arguments.volume_min.empty()) {
    if (const auto corner = ParseNumbers(arguments.volume_min, {3}, "--volume-min")) {
      volume.mutable_expert()->set_min_x_m((*corner)[0]);
      volume.mutable_expert()->set_min_y_m((*corner)[1]);
      volume.mutable_expert()->set_min_z_m((*corner)[2]);
    } else {
      problems.Add(corner.error());
    }
  }
  if (arguments.voxel) volume.set_voxel_size_m(*arguments.voxel);
  if (!arguments.initial_pose.empty()) {
    if (const auto pose = ParsePose(arguments.initial_pose)) {
      *volume.mutable_expert()->mutable_initial_pose() = ToOptions(*pose);
    } else {
      problems.Add(pose.error().WithContext("--initial-pose"));
    }
  }
  // After the configuration, which the command line overrides.
  if (arguments.threads) options.set_threads(*arguments.threads);
  AddInvalid(options, problems);
  return options;
}

Result<std::optional<RigidTransform>> InitialPose(const ScanArguments& arguments) {
  if (arguments.initial_pose_from.empty()) return std::optional<RigidTransform>();
  const auto poses = ReadTruePoses(arguments.initial_pose_from);
  if (!poses) return Err(poses.error());
  const auto time = FirstDepthTime(arguments.recording);
  if (!time) return Err(time.error());
  const auto pose = PoseAt(*poses, *time);
  if (!pose) return Err(pose.error().WithContext(arguments.initial_pose_from));
  return std::optional<RigidTransform>(*pose);
}

}  // namespace

std::vector<CLI::Option*> AddScanOptions(CLI::App& command, ScanArguments& arguments) {
  CLI::Option* pose =
      command.add_option("--initial-pose", arguments.initial_pose,
                         "T_world_depth of the first depth frame, \"x y z qx qy qz qw\"");
  CLI::Option* pose_from =
      command.add_option("--initial-pose-from", arguments.initial_pose_from,
                         "Take it from this trajectory, or from the ground truth in a recording "
                         "(.mcap)");
  pose_from->excludes(pose);
  AddConfigurationArguments(command, arguments.configuration);
  return {pose_from,
          pose,
          command.get_option("--config"),
          command.get_option("--set"),
          command.add_option("--volume", arguments.volume,
                             "Edge length of the scan volume, or \"x y z\", metres"),
          command.add_option("--volume-min", arguments.volume_min,
                             "Corner with the smallest coordinates, \"x y z\", metres"),
          command.add_option("--voxel", arguments.voxel, "Edge length of a voxel, metres"),
          command.add_option("--threads", arguments.threads, "Threads; 0 = one per core")};
}

int CollectScanOptions(const ScanArguments& arguments, ReconstructRequest& request) {
  const std::string& file = arguments.configuration.file;
  // A missing file is exit status 66, a wrong one 78.
  if (std::error_code error; !file.empty() && !std::filesystem::exists(file, error)) {
    return Fail(NotFound(file + ": there is no such configuration file"));
  }
  Problems problems;
  request.options = CollectOptions(arguments, problems);
  return problems.empty() ? 0 : FailConfiguration(problems.text());
}

Status FindScan(const ScanArguments& arguments, ReconstructRequest& request) {
  const auto pose = InitialPose(arguments);
  if (!pose) return pose.error();
  request.initial_pose = *pose;
  if (!arguments.rig.empty()) {
    Result<Rig> rig = LoadRigCalibration(arguments.rig);
    if (!rig) return rig.error();
    request.rig = std::move(*rig);
  }
  request.recording = arguments.recording;
  return OkStatus();
}

}  // namespace isotherm
