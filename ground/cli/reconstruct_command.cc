#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/progress.h"
#include "common/config/text_proto.h"
#include "common/geometry/pose_text.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/numbers.h"
#include "ground/cli/truth.h"
#include "ground/export/result_files.h"
#include "ground/offline/reconstruct.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

constexpr const char* kReconstructFooter =
    R"(The scan volume is a box in `world` from --volume-min, axes along its edges. The initial pose is
T_world_depth of the first depth frame; without one the volume's centre lies on the first
frame's optical axis at the median depth. Options come from the defaults, the configuration
file, --set and the other options, the later ones winning.

Voxels may be larger for a larger volume: surfaces are then cut off four voxels behind
(tsdf.truncation_distance_m).

DIR gets trajectory.txt, cloud.ply, mesh.ply, renders/*.png, stats.json and model.iso. With
--continue the volume and `world` are the model's, and the rig is looked for around the poses of the
earlier scan. If nothing was tracked, no temperature was assigned, or the recording cannot be right
(units, clocks), a warning and stats.json say why, and the exit status is 65.

Examples:
  isotherm reconstruct scan.mcap -o out
  isotherm reconstruct room.mcap -o out --volume "4 3 4" --voxel 0.006
  isotherm reconstruct door.mcap -o out --volume 0.96 --volume-min "-0.48 -0.48 -0.48" \
      --initial-pose-from groundtruth.txt
  isotherm reconstruct next_day.mcap -o out2 --continue out/model.iso)";

struct ReconstructArguments {
  std::string rig;
  std::string recording, output, model, volume, volume_min, initial_pose, initial_pose_from;
  ConfigurationArguments configuration;
  std::optional<double> voxel;
  std::optional<int> threads;
  bool force = false;
};

GroundOptions CollectOptions(const ReconstructArguments& arguments, Problems& problems) {
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
  if (arguments.threads) options.set_threads(*arguments.threads);
  AddInvalid(options, problems);
  return options;
}

Result<std::optional<RigidTransform>> InitialPose(const ReconstructArguments& arguments) {
  if (arguments.initial_pose_from.empty()) return std::optional<RigidTransform>();
  const auto poses = ReadTruePoses(arguments.initial_pose_from);
  if (!poses) return Err(poses.error());
  const auto time = FirstDepthTime(arguments.recording);
  if (!time) return Err(time.error());
  const auto pose = PoseAt(*poses, *time);
  if (!pose) return Err(pose.error().WithContext(arguments.initial_pose_from));
  return std::optional<RigidTransform>(*pose);
}

int Run(const ReconstructArguments& arguments) {
  ReconstructRequest request;
  if (std::error_code error; !arguments.configuration.file.empty() &&
                             !std::filesystem::exists(arguments.configuration.file, error)) {
    return Fail(NotFound(arguments.configuration.file + ": there is no such configuration file"));
  }
  Problems problems;
  request.options = CollectOptions(arguments, problems);
  if (!problems.empty()) return FailConfiguration(problems.text());
  if (!arguments.force && HoldsResults(arguments.output)) {
    return Fail(InvalidArgument(fmt::format(
        "{}: has results of another scan; --force replaces them, -o names another folder",
        arguments.output)));
  }
  const auto pose = InitialPose(arguments);
  if (!pose) return Fail(pose.error());
  request.initial_pose = *pose;
  if (!arguments.rig.empty()) {
    Result<Rig> rig = LoadRigCalibration(arguments.rig);
    if (!rig) return Fail(rig.error());
    request.rig = std::move(*rig);
  }
  request.recording = arguments.recording;
  request.output_dir = arguments.output;
  request.model = arguments.model;
  std::optional<ProgressBar> progress;
  request.progress = [&](double fraction, std::string_view) {
    if (!progress) progress.emplace("reconstructing", 0, "");
    progress->Update(fraction);
  };
  const Result<ReconstructSummary> summary = Reconstruct(request);
  if (summary && progress) progress->Finish();
  progress.reset();
  if (!summary) return Fail(summary.error());
  std::fwrite(summary->text.data(), 1, summary->text.size(), stdout);
  return Warn(summary->doubts);
}

}  // namespace

void AddReconstructCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("reconstruct", "Turns a recording into a 3D thermogram");
  auto arguments = std::make_shared<ReconstructArguments>();
  command->add_option("recording", arguments->recording, "Recording (.mcap)")->required();
  command->add_option("-o,--output", arguments->output, "Folder for the results")->required();
  CLI::Option* model =
      command->add_option("--continue", arguments->model,
                          "Go on with the model of an earlier scan (model.iso) of the same place");
  command->add_option("--volume", arguments->volume,
                      "Edge length of the scan volume, or \"x y z\", metres");
  command->add_option("--volume-min", arguments->volume_min,
                      "Corner with the smallest coordinates, \"x y z\", metres");
  command->add_option("--voxel", arguments->voxel, "Edge length of a voxel, metres");
  CLI::Option* pose =
      command->add_option("--initial-pose", arguments->initial_pose,
                          "T_world_depth of the first depth frame, \"x y z qx qy qz qw\"");
  command
      ->add_option("--initial-pose-from", arguments->initial_pose_from,
                   "Take it from this trajectory, or from the ground truth in a recording (.mcap)")
      ->excludes(pose)
      ->excludes(model);
  command->add_option("--rig", arguments->rig,
                      "Rig calibration (rig.textproto) instead of the one in the recording");
  command->add_option("--threads", arguments->threads, "Threads; 0 = one per core");
  command->add_flag("--force", arguments->force, "Replace results that are in the folder");
  AddConfigurationArguments(*command, arguments->configuration);
  command->footer(kReconstructFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
