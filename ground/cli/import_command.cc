#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>

#include "common/base/progress.h"
#include "common/base/service.h"
#include "common/dataset/import.h"
#include "common/options/nearest_name.h"
#include "ground/cli/command.h"

namespace isotherm {
namespace {

constexpr const char* kImportFooter =
    R"(The folder holds rig.textproto, depth.txt with depth/*.png and, optionally, thermal.txt with
thermal/*.png, nuc.txt and groundtruth.txt. Lists have 'timestamp_s filename' per line; images
are 16-bit PNG (raw depth; temperatures in centi-kelvin, or as thermal_scale and thermal_offset in
rig.textproto say). Frames inside the intervals of nuc.txt are recorded as invalid. The recording appears under its name only when it is complete. Stamps, units and
temperatures that cannot be right are recorded as they are, with a warning and exit status 65.

Examples:
  isotherm import --from tum ~/scans/door -o door.mcap
  isotherm import --from tum ~/scans/door --external-odometry vio.txt -o door.mcap
  isotherm import ~/scans/door -o view.mcap --encoding viewable    for Foxglove and Lichtblick)";

struct ImportArguments {
  std::string format = "tum";
  std::string folder, output, thermal_list, rig, external_odometry;
  int storage = static_cast<int>(ImageStorage::kCompact);
  bool force = false;
  bool skip_bad = false;
};

void Print(const ImportSummary& summary, const std::string& output) {
  fmt::print("{}: {} depth frames, {} thermal frames", output, summary.depth_frames,
             summary.thermal_frames);
  if (summary.thermal_frames_in_nuc > 0)
    fmt::print(" ({} with the shutter closed)", summary.thermal_frames_in_nuc);
  if (summary.groundtruth_poses > 0) fmt::print(", {} true poses", summary.groundtruth_poses);
  if (summary.external_odometry > 0) fmt::print(", {} odometry poses", summary.external_odometry);
  fmt::print("; {:.1f} MB", 1e-6 * static_cast<double>(summary.recording_bytes));
  if (summary.image_bytes > 0) {
    fmt::print(", {:.1f} % of the raw images", 100.0 *
                                                   static_cast<double>(summary.recording_bytes) /
                                                   static_cast<double>(summary.image_bytes));
  }
  fmt::print("\n");
  for (const std::string& note : summary.notes) fmt::print("note: {}\n", note);
  if (summary.skipped_images > 0)
    fmt::print("note: {} bad images were left out\n", summary.skipped_images);
}

int Run(const ImportArguments& arguments) {
  const StopSignal signal;  // Before any other thread.
  ImportRequest request;
  request.stop = signal.token();
  request.dataset.folder = arguments.folder;
  if (!arguments.thermal_list.empty()) request.dataset.thermal_list = arguments.thermal_list;
  if (!arguments.rig.empty()) request.dataset.rig = arguments.rig;
  if (!arguments.external_odometry.empty())
    request.dataset.external_odometry = arguments.external_odometry;
  request.recording = arguments.output;
  request.storage = static_cast<ImageStorage>(arguments.storage);
  request.overwrite = arguments.force;
  request.skip_bad = arguments.skip_bad;
  request.software = SoftwareName();
  std::optional<ProgressBar> progress;
  request.progress = [&](double fraction) {
    if (!progress) progress.emplace("importing", 0, "");
    progress->Update(fraction);
  };
  const Result<ImportSummary> summary = ImportDataset(request);
  if (summary && progress) progress->Finish();
  progress.reset();
  if (!summary) return Fail(summary.error());
  Print(*summary, arguments.output);
  return Warn(summary->doubts);
}

}  // namespace

void AddImportCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("import", "Turns a folder of images and time stamps into a recording");
  auto arguments = std::make_shared<ImportArguments>();
  command->add_option("folder", arguments->folder, "Dataset folder")->required();
  command->add_option("--from", arguments->format, "Layout of the folder: tum (TUM RGB-D style)")
      ->check(CLI::IsMember({"tum"}))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Recording to write (.mcap)")->required();
  command->add_option("--thermal-list", arguments->thermal_list,
                      "Another list of thermal stamps than thermal.txt");
  command->add_option("--rig", arguments->rig,
                      "Another calibration than the folder's rig.textproto");
  command->add_option("--external-odometry", arguments->external_odometry,
                      "Poses that external odometry measured (visual-inertial odometry, motion "
                      "capture), TUM format, on the clock of the lists");
  command
      ->add_option("--encoding", arguments->storage,
                   "compact (default, smallest) or viewable (larger; MCAP viewers show the images)")
      ->transform(
          CLI::Validator(NumberOfName({{"compact", static_cast<int>(ImageStorage::kCompact)},
                                       {"viewable", static_cast<int>(ImageStorage::kViewable)}}),
                         ""))
      ->type_name("KIND");
  command->add_flag("--force", arguments->force, "Replace an existing recording");
  command->add_flag("--skip-bad", arguments->skip_bad,
                    "Leave unreadable images out instead of stopping");
  command->footer(kImportFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
