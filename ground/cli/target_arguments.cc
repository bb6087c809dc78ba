#include "ground/cli/target_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "common/base/output_file.h"
#include "common/base/progress.h"
#include "common/concurrency/thread_pool.h"
#include "ground/camera_calibration/rig_file.h"
#include "ground/camera_calibration/target.h"
#include "ground/cli/command.h"
#include "ground/cli/live_series.h"
#include "ground/cli/simulation_files.h"
#include "ground/cli/today.h"
#include "ground/json/json.h"

namespace isotherm {
namespace {

const std::map<std::string, LensKind>& LensNames() {
  static const std::map<std::string, LensKind> kNames = {
      {"brown-conrady", LensKind::kBrownConrady}};
  return kNames;
}

Status WriteReport(const CalibrationReport& report, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return IoError(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
  ISOTHERM_RETURN_IF_ERROR(WriteFile(folder / "report.txt", ReportText(report)));
  ISOTHERM_RETURN_IF_ERROR(WriteFile(folder / "report.json", JsonText(ReportJson(report))));
  ISOTHERM_RETURN_IF_ERROR(WriteFile(folder / "report.html", ReportHtml(report)));
  fmt::print("{}: report.txt, report.json and report.html written\n", folder.string());
  return OkStatus();
}

}  // namespace

void AddTargetArguments(CLI::App& command, TargetArguments& arguments) {
  CLI::Option* recording =
      command.add_option("recording", arguments.recording,
                         "Recording (.mcap) in which the target rests for a second in each pose");
  CLI::Option* images =
      command
          .add_option("--images", arguments.images,
                      "Folder of grey PNG files instead, one or more for each pose")
          ->excludes(recording);
  command
      .add_flag("--live", arguments.live,
                "From a running rig instead, until Ctrl-C: after each pose it says which are still "
                "missing. No ground station may follow the rig meanwhile")
      ->excludes(recording)
      ->excludes(images);
  AddRigAddress(command, arguments.address);
  command.add_option("--target", arguments.target, "What the target is, see below")
      ->capture_default_str();
  command.add_option("-o,--output", arguments.rig,
                     "Rig file to write, or to update: its other values stay, and as it was it is "
                     "kept as FILE.bak");
  command.add_option("--report", arguments.report,
                     "Folder for report.txt, report.json and report.html");
  command
      .add_option("--resamplings", arguments.bootstrap,
                  "How many calibrations from resampled views say how far they depend on these")
      ->check(CLI::Range(100, 100000))
      ->capture_default_str();
  command.add_option("--threads", arguments.threads, "Threads; 0 = one per core");
}

Result<std::vector<ImageSeries>> ReadSeries(const TargetArguments& arguments,
                                            const std::vector<CalibratedStream>& streams) {
  if (arguments.live) {
    if (std::ranges::count(streams, CalibratedStream::kInfrared) > 0) {
      return Err(InvalidArgument(
          "--live: a rig sends no infrared images; calibrate on depth, or from --images"));
    }
    const Result<CalibrationTarget> target = ParseTarget(arguments.target);
    if (!target) return Err(target.error());
    return TakeLiveSeries(arguments.address, *target, streams);
  }
  if (arguments.images.empty() && arguments.recording.empty()) {
    return Err(
        InvalidArgument("nothing to calibrate from: name a recording, a folder with --images, or "
                        "say --live"));
  }
  std::vector<ImageSeries> all;
  for (const CalibratedStream stream : streams) {
    ProgressBar bar(fmt::format("reading {} images", ToString(stream)), 0, "");
    const auto progress = [&](double fraction) { bar.Update(fraction); };
    Result<ImageSeries> series = arguments.images.empty()
                                     ? ReadStillPoses(arguments.recording, stream, progress)
                                     : ReadImageFolder(arguments.images, stream, progress);
    if (!series) return Err(series.error());
    bar.Finish();
    all.push_back(std::move(*series));
  }
  return all;
}

Status CalibrateAndReport(const TargetArguments& arguments,
                          const std::vector<std::string>& camera_names,
                          std::vector<CalibrationView> views,
                          const std::vector<std::string>& serials) {
  const Result<CalibrationTarget> target = ParseTarget(arguments.target);
  if (!target) return target.error();
  CalibrationInput input;
  input.target = *target;
  input.camera_names = camera_names;
  input.lenses.assign(camera_names.size(), LensNames().at(arguments.lens));
  input.views = std::move(views);
  ThreadPool pool(ChosenThreads(arguments.threads));
  Result<TargetCalibration> calibration = [&] {
    ProgressBar bar("calibrating", 0, "");
    Result<TargetCalibration> result =
        CalibrateWithTarget(input, pool, [&](double fraction) { bar.Update(fraction); });
    if (result) bar.Finish();
    return result;
  }();
  if (!calibration) return calibration.error();
  CalibrationReport report =
      MakeReport(*calibration, camera_names, {.bootstrap_samples = arguments.bootstrap});
  report.date = Today();
  report.software = SoftwareName();
  report.source = arguments.live             ? "a running rig"
                  : arguments.images.empty() ? arguments.recording
                                             : arguments.images;
  fmt::print("{}", ReportText(report));
  if (!arguments.report.empty()) ISOTHERM_RETURN_IF_ERROR(WriteReport(report, arguments.report));
  if (arguments.rig.empty()) return OkStatus();
  ISOTHERM_RETURN_IF_ERROR(UpdateRigFile(arguments.rig, report, serials));
  fmt::print("{}: written\n", arguments.rig);
  return OkStatus();
}

}  // namespace isotherm
