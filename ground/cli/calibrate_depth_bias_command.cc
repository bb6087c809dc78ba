#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "common/base/output_file.h"
#include "common/base/progress.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "ground/camera_calibration/depth_bias_scan.h"
#include "ground/cli/calibrated_rig_file.h"
#include "ground/cli/command.h"
#include "ground/cli/today.h"
#include "ground/json/json.h"

namespace isotherm {
namespace {

constexpr const char* kFooter =
    R"(Finds by what the depth camera's distances have to be multiplied to be right, over the image and the distance:
walls bend, swell or sink towards the corners. Record a bare flat wall that fills the image, for half a minute:
from as near as you scan to as far, slowly, turned to either side by 20 degrees now and then. What else is seen
is left out if it stands off the wall by more than a twentieth of the distance; a frame of less than that harms.
A third of the scan is held out and must be flatter afterwards.

A wall tells neither how far away it is nor how it is turned: in the middle of the image distances are taken as
right, and what grows across or down the image near its middle as none.

Without --apply or --output nothing is written. The calibration's depth_sensor.bias is replaced; comments of the
file are lost, and as it was it is kept beside it (FILE.bak). The ground corrects each depth image by it before
anything else; recordings stay as measured.

Examples:
  isotherm calibrate depth-bias wall.mcap
  isotherm calibrate depth-bias wall.mcap --rig rig.textproto --apply)";

struct Arguments {
  std::string recording, rig, output, json;
  bool apply = false;
};

/// Rows of a table: the multipliers in corners, at the sides and in the middle, of each distance.
std::string TableText(const DepthBias& bias) {
  std::string text = fmt::format("{:>12}{:>16}{:>16}{:>16}{:>16}\n", "distance", "corners (mean)",
                                 "left / right", "top / bottom", "most / least");
  for (std::size_t k = 0; k < bias.distances_m.size(); ++k) {
    const int layer = static_cast<int>(k);
    const auto percent = [&](double x, double y) {
      return 100.0 * (bias.InLayer(layer, x, y) - 1.0);
    };
    const double corners =
        0.25 * (percent(0.0, 0.0) + percent(1.0, 0.0) + percent(0.0, 1.0) + percent(1.0, 1.0));
    double least = 100.0, most = -100.0;
    for (int row = 0; row < bias.rows; ++row)
      for (int column = 0; column < bias.columns; ++column) {
        const double node = 100.0 * (bias.Node(layer, row, column) - 1.0);
        least = std::min(least, node);
        most = std::max(most, node);
      }
    const auto pair = [](double a, double b) { return fmt::format("{:+.2f} / {:+.2f}", a, b); };
    text += fmt::format("{:>10.2f} m{:>+14.2f} %{:>14} %{:>14} %{:>14} %\n", bias.distances_m[k],
                        corners, pair(percent(0.0, 0.5), percent(1.0, 0.5)),
                        pair(percent(0.5, 0.0), percent(0.5, 1.0)), pair(most, least));
  }
  return text;
}

std::string ReportText(const DepthBiasReport& report) {
  const auto rms = [](double fraction) {
    constexpr double kAt_m = 0.6;
    return fmt::format("{:.2f} % ({:.1f} mm at {:.1f} m)", 100.0 * fraction, 1e3 * kAt_m * fraction,
                       kAt_m);
  };
  std::string text = fmt::format("a wall, {:.2f} to {:.2f} m away, in {} of {} depth frames\n",
                                 report.near_m, report.far_m, report.walls, report.frames);
  text += "what distances have to change by:\n" + TableText(report.bias);
  text += fmt::format("unevenness of the wall, of what was held out: {} before, {} after\n",
                      rms(report.before_rms), rms(report.after_rms));
  text += fmt::format("two halves of the scan differ by {:.2f} %\n", 100.0 * report.halves_rms);
  if (report.bias.distances_m.size() == 1)
    text += "the wall was seen at one distance, at which the table is taken for all others\n";
  if (report.seen_nodes < report.nodes)
    text += fmt::format(
        "the wall was seen at {} of {} places of the table (image and distance): the others take "
        "after their neighbours\n",
        report.seen_nodes, report.nodes);
  return text;
}

Json ReportJson(const DepthBiasReport& report) {
  Json json;
  json["frames"] = report.frames;
  json["walls"] = report.walls;
  json["near_m"] = report.near_m;
  json["far_m"] = report.far_m;
  json["seen_nodes"] = report.seen_nodes;
  json["nodes"] = report.nodes;
  json["before_rms"] = report.before_rms;
  json["after_rms"] = report.after_rms;
  json["halves_rms"] = report.halves_rms;
  json["columns"] = report.bias.columns;
  json["rows"] = report.bias.rows;
  json["distance_m"] = report.bias.distances_m;
  json["multiplier"] = report.bias.multipliers;
  return json;
}

void SetBias(const Arguments& arguments, const DepthBiasReport& report, RigCalibration& rig) {
  DepthSensorModel found;
  found.bias = report.bias;
  *rig.mutable_depth_sensor()->mutable_bias() = ToProto(found).bias();
  CalibrationRecord& record = *rig.mutable_depth_bias_calibration();
  record.Clear();
  record.set_date(Today());
  record.set_method(fmt::format("{}, calibrate depth-bias", SoftwareName()));
  record.set_target(fmt::format("wall {}", arguments.recording));
  if (rig.has_depth_serial()) record.set_serial(rig.depth_serial());
  record.set_views(static_cast<int>(report.walls));
  record.set_refused(static_cast<int>(report.frames - report.walls));
}

int Run(const Arguments& arguments) {
  std::optional<Rig> rig;
  if (!arguments.rig.empty()) {
    Result<Rig> loaded = LoadRigCalibration(arguments.rig);
    if (!loaded) return Fail(loaded.error());
    rig = std::move(*loaded);
  }
  const Result<DepthBiasReport> report = [&] {
    ProgressBar bar("calibrating", 0, "");
    auto result =
        FindDepthBias(arguments.recording, rig, [&](double fraction) { bar.Update(fraction); });
    if (result) bar.Finish();
    return result;
  }();
  if (!report) return Fail(report.error());
  fmt::print("{}", ReportText(*report));
  if (!arguments.json.empty()) {
    if (Status status = WriteFile(arguments.json, JsonText(ReportJson(*report))); !status.ok())
      return Fail(status);
    fmt::print("{}: written\n", arguments.json);
  }
  if (!report->Improves()) {
    fmt::print("the calibration at hand makes the wall as flat: nothing to write{}\n",
               arguments.output.empty() ? "" : fmt::format(", {} is not made", arguments.output));
    return 0;
  }
  if (arguments.output.empty() && !arguments.apply) {
    fmt::print("nothing is written: --apply changes the file of --rig, --output writes another\n");
    return 0;
  }
  const Status written =
      WriteCalibratedRig({arguments.rig, arguments.apply ? arguments.rig : arguments.output}, *rig,
                         [&](RigCalibration& file) { SetBias(arguments, *report, file); });
  return written.ok() ? 0 : Fail(written);
}

}  // namespace

void AddCalibrateDepthBiasCommand(CLI::App& calibrate, CommandBody& body) {
  CLI::App* command = calibrate.add_subcommand(
      "depth-bias", "By what the depth camera's distances are wrong, from a flat wall");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("recording", arguments->recording, "Recording of the wall (.mcap)")
      ->required();
  CLI::Option* rig_option =
      command->add_option("--rig", arguments->rig,
                          "Calibration to compare with and to change; without, the recording's");
  CLI::Option* apply_option =
      command->add_flag("--apply", arguments->apply, "Change the file of --rig")->needs(rig_option);
  command->add_option("-o,--output", arguments->output, "Write the calibration here instead")
      ->excludes(apply_option);
  command->add_option("--json", arguments->json, "Write all values (.json)");
  command->footer(kFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
