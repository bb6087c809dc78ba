#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/progress.h"
#include "ground/cli/command.h"
#include "ground/cli/scan_arguments.h"
#include "ground/export/result_files.h"
#include "ground/offline/reconstruct.h"

namespace isotherm {
namespace {

constexpr const char* kReconstructFooter =
    R"(The scan volume is a box in `world` from --volume-min, axes along its edges. The initial pose is
T_world_depth of the first depth frame; without one the volume's centre lies on the first
frame's optical axis at the median depth. Options come from the defaults, the configuration
file, --set and the other options, the later ones winning.

Voxels may be larger for a larger volume: surfaces are then cut off four voxels behind
(tsdf.expert.truncation_distance_m).

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
  ScanArguments scan;
  std::string output, model;
  bool force = false;
};

int Run(const ReconstructArguments& arguments) {
  ReconstructRequest request;
  if (const int status = CollectScanOptions(arguments.scan, request); status != 0) return status;
  if (!arguments.force && HoldsResults(arguments.output)) {
    return Fail(InvalidArgument(fmt::format(
        "{}: has results of another scan; --force replaces them, -o names another folder",
        arguments.output)));
  }
  if (const Status status = FindScan(arguments.scan, request); !status.ok()) return Fail(status);
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
  command->add_option("recording", arguments->scan.recording, "Recording (.mcap)")->required();
  command->add_option("-o,--output", arguments->output, "Folder for the results")->required();
  CLI::Option* model =
      command->add_option("--continue", arguments->model,
                          "Go on with the model of an earlier scan (model.iso) of the same place");
  AddScanOptions(*command, arguments->scan).front()->excludes(model);
  command->add_option("--rig", arguments->scan.rig,
                      "Rig calibration (rig.textproto) instead of the one in the recording");
  command->add_flag("--force", arguments->force, "Replace results that are in the folder");
  command->footer(kReconstructFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
