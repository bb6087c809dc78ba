#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "ground/camera_calibration/target.h"
#include "ground/cli/command.h"
#include "ground/cli/target_arguments.h"

namespace isotherm {
namespace {

constexpr const char* kCalibrateRigFooter =
    R"(Calibrates both lenses and the pose of the thermal camera to the depth camera in one, from views in
which both see the target. Images of only one camera help its lens. Of image folders, FOLDER holds
thermal.txt and infrared.txt (or depth.txt), lists of "seconds file" as in data sets: what overlaps in
time is one view.

)";

constexpr const char* kCalibrateRigExamples = R"(

Examples:
  isotherm calibrate rig scan.mcap -o rig.textproto --report calibration
  isotherm calibrate rig --live --target thesis-board -o rig.textproto
  isotherm calibrate rig --images calibration/ --infrared -o rig.textproto)";

int RunCalibrateRig(const TargetArguments& arguments) {
  Result<std::vector<ImageSeries>> series =
      ReadSeries(arguments, {DepthStream(arguments), CalibratedStream::kThermal});
  if (!series) return Fail(series.error());
  ImageSeries &depth = series->front(), &thermal = series->back();
  const std::vector<std::string> serials = {depth.serial, thermal.serial};
  const Status status = CalibrateAndReport(
      arguments, {"depth", "thermal"}, PairViews(std::move(depth), std::move(thermal)), serials);
  return status.ok() ? 0 : Fail(status);
}

}  // namespace

void AddCalibrateRigCommand(CLI::App& calibrate, CommandBody& body) {
  CLI::App* command = calibrate.add_subcommand(
      "rig", "Both lenses and the pose between the cameras, with a target");
  auto arguments = std::make_shared<TargetArguments>();
  AddTargetArguments(*command, *arguments);
  AddDepthArguments(*command, *arguments);
  AddDepthLens(*command, *arguments);
  command->footer(kCalibrateRigFooter + std::string(TargetHelp()) + kCalibrateRigExamples);
  command->callback(
      [arguments, &body] { body = [arguments] { return RunCalibrateRig(*arguments); }; });
}

}  // namespace isotherm
