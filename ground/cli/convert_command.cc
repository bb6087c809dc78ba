#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>

#include "common/dataset/trajectory.h"
#include "common/options/nearest_name.h"
#include "ground/cli/command.h"
#include "ground/cli/conversion.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConvertFooter =
    R"(A recording is compact (Isotherm's own lossless codes: small, and only Isotherm reads them) or viewable
(plain 16-bit images and transforms: two to three times as large, and Foxglove and Lichtblick show them).
Nothing is lost either way, unless --spoil-depth says so; every command reads both. `isotherm inspect` says which of them a file is.

A viewable recording has the topics /depth and /thermal (foxglove.RawImage, 16UC1), their camera_info
(foxglove.CameraCalibration), and transforms (foxglove.FrameTransform) between world, depth and
thermal. Poses of the rig are those of --trajectory (a result folder of `isotherm reconstruct`, or a
file in TUM format), or else those that the recording has from the ground's feedback. In an image panel set
the value range: thermal pixels are centi-kelvin (29300 is 19.85 °C) unless `isotherm inspect` names another thermal scale.

Examples:
  isotherm convert scan.mcap -o view.mcap --encoding viewable --trajectory out/scan
  isotherm convert view.mcap -o small.mcap --encoding compact
  isotherm convert scan.mcap -o holes.mcap --encoding compact --spoil-depth grid)";

std::map<std::string, int> NumbersOfDefects() {
  std::map<std::string, int> numbers;
  for (const DepthDefect defect : kDepthDefects)
    numbers.emplace(ToString(defect), static_cast<int>(defect));
  return numbers;
}

struct ConvertArguments {
  std::string recording, output, trajectory;
  ImageStorage storage = ImageStorage::kViewable;
  int defect = static_cast<int>(DepthDefect::kNone);
  bool force = false;
};

Result<std::vector<StampedPose>> PosesOf(const std::string& place) {
  if (place.empty()) return std::vector<StampedPose>();
  std::error_code error;
  const fs::path path =
      fs::is_directory(place, error) ? fs::path(place) / "trajectory.txt" : fs::path(place);
  Result<std::vector<StampedPose>> poses = ReadTrajectory(path);
  if (poses && poses->empty()) return Err(DataLoss(path.string() + ": has no poses"));
  return poses;
}

void Print(const ConvertSummary& summary, const ConvertArguments& arguments) {
  std::error_code error;
  const auto before = static_cast<double>(fs::file_size(arguments.recording, error));
  const auto after = static_cast<double>(fs::file_size(arguments.output, error));
  fmt::print("{}: {} depth and {} thermal frames; {:.1f} MB ({:.1f} MB before)\n", arguments.output,
             summary.depth_frames, summary.thermal_frames, 1e-6 * after, 1e-6 * before);
  if (summary.poses > 0) {
    fmt::print("poses    {} of the rig, from {}\n", summary.poses, summary.poses_from);
  } else {
    fmt::print(
        "poses    none: images show, but a 3D panel has nothing to move (--trajectory names "
        "a result of isotherm reconstruct)\n");
  }
  if (!summary.has_thermal_pose)
    fmt::print(
        "note: the calibration has no T_thermal_depth: no transform of the thermal camera\n");
  if (summary.left_out > 0)
    fmt::print("note: {} damaged messages were left out\n", summary.left_out);
}

int Run(const ConvertArguments& arguments) {
  auto poses = PosesOf(arguments.trajectory);
  if (!poses) return Fail(poses.error());
  ConvertRequest request;
  request.recording = arguments.recording;
  request.storage = arguments.storage;
  request.poses = std::move(*poses);
  request.defect = static_cast<DepthDefect>(arguments.defect);
  const Result<ConvertSummary> summary = ConvertInto(
      {.output = arguments.output, .force = arguments.force, .verb = "converting"}, request);
  if (!summary) return Fail(summary.error());
  Print(*summary, arguments);
  return 0;
}

}  // namespace

void AddConvertCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand(
      "convert", "Writes a recording anew: for Foxglove and Lichtblick, or as small as it can be");
  auto arguments = std::make_shared<ConvertArguments>();
  command->add_option("recording", arguments->recording, "Recording (.mcap)")->required();
  command->add_option("-o,--output", arguments->output, "Recording to write (.mcap)")->required();
  AddEncodingOption(*command, arguments->storage,
                    "viewable (default; Foxglove and Lichtblick show it) or compact");
  command->add_option("--trajectory", arguments->trajectory,
                      "Poses of the rig: result folder, or trajectory.txt");
  command
      ->add_option("--spoil-depth", arguments->defect,
                   "To try what a worse camera would give: grid (every third row and column empty, "
                   "64 % of the pixels in all), coarse-grid (two of five rows and columns), random "
                   "(60 %), rows, columns (every second) or flying (30 % of the pixels at edges "
                   "lie between the surfaces)")
      ->transform(CLI::Validator(NumberOfName(NumbersOfDefects()), ""))
      ->type_name("KIND");
  command->add_flag("--force", arguments->force, "Replace an existing recording");
  command->footer(kConvertFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
