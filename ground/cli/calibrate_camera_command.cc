#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "ground/camera_calibration/target.h"
#include "ground/cli/command.h"
#include "ground/cli/target_arguments.h"

namespace isotherm {
namespace {

constexpr const char* kCalibrateCameraFooter =
    R"(Finds focal lengths, principal point and distortion from images of a flat target, together with the
target's own warp, and says how certain the result is all over the image. Take 30 poses or more: near
and far within the sharp range, tilted by 30 to 45 degrees about both axes, and into every corner; hold
each for a second. A small reprojection error proves nothing: see the uncertainty, and whether two
halves of the views agree.

)";

constexpr const char* kCalibrateCameraExamples = R"(

Examples:
  isotherm calibrate thermal scan.mcap -o rig.textproto --report calibration
  isotherm calibrate thermal --live --edge-id edge -o rig.textproto
  isotherm calibrate thermal --images thermal/ --target "asymmetric-circles 4x9 0.05 thickness=0.001"
  isotherm calibrate thermal scan.mcap --lens fisheye -o rig.textproto
  isotherm calibrate depth scan.mcap -o rig.textproto                    by the holes, in depth itself
  isotherm calibrate depth --infrared --images infrared/ --target "chessboard 8x6 0.03" -o rig.textproto)";

int RunCalibrateCamera(const TargetArguments& arguments, bool thermal) {
  const CalibratedStream stream = thermal ? CalibratedStream::kThermal : DepthStream(arguments);
  Result<std::vector<ImageSeries>> series = ReadSeries(arguments, {stream});
  if (!series) return Fail(series.error());
  const std::string serial = series->front().serial;
  const Status status = CalibrateAndReport(arguments, {thermal ? "thermal" : "depth"},
                                           ViewsOf(std::move(series->front())), {serial});
  return status.ok() ? 0 : Fail(status);
}

void AddCamera(CLI::App& calibrate, CommandBody& body, bool thermal) {
  CLI::App* command = calibrate.add_subcommand(
      thermal ? "thermal" : "depth", thermal ? "The lens of the thermal camera, with a target"
                                             : "The lens of the depth camera, with a target");
  auto arguments = std::make_shared<TargetArguments>();
  AddTargetArguments(*command, *arguments);
  if (!thermal) AddDepthArguments(*command, *arguments);
  command->footer(kCalibrateCameraFooter + std::string(TargetHelp()) + kCalibrateCameraExamples);
  command->callback([arguments, thermal, &body] {
    body = [arguments, thermal] { return RunCalibrateCamera(*arguments, thermal); };
  });
}

}  // namespace

void AddCalibrateCameraCommands(CLI::App& calibrate, CommandBody& body) {
  AddCamera(calibrate, body, true);
  AddCamera(calibrate, body, false);
}

}  // namespace isotherm
