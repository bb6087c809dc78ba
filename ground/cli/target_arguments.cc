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
  static const std::map<std::string, LensKind> kNames = [] {
    std::map<std::string, LensKind> names;
    for (const LensKind kind : {LensKind::kBrownConrady, LensKind::kRational, LensKind::kFisheye})
      names.emplace(ToString(kind), kind);
    return names;
  }();
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

void AddLensOption(CLI::App& command, const char* name, std::string& lens, const char* help) {
  command.add_option(name, lens, help)->check(CLI::IsMember(LensNames()))->capture_default_str();
}

/// The lens models of cameras, by name.
std::vector<LensKind> LensesOf(const TargetArguments& arguments,
                               const std::vector<std::string>& camera_names) {
  std::vector<LensKind> lenses;
  for (const std::string& name : camera_names) {
    const bool second = camera_names.size() > 1 && name == "depth";
    lenses.push_back(LensNames().at(second ? arguments.depth_lens : arguments.lens));
  }
  return lenses;
}

Status CheckStreams(const TargetArguments& arguments, const CalibrationTarget& target,
                    const std::vector<CalibratedStream>& streams) {
  if (arguments.infrared && arguments.images.empty()) {
    return InvalidArgument(
        arguments.live
            ? "--live: a rig sends no infrared images; calibrate on depth, or from --images"
            : "--infrared: a recording holds no infrared images; calibrate on depth, or from "
              "--images");
  }
  if (std::ranges::count(streams, CalibratedStream::kDepth) > 0 && !target.HasHoles()) {
    return InvalidArgument(
        "a chessboard has no holes that depth images could show: calibrate on infrared images "
        "(--infrared), or with a target with holes");
  }
  if (!arguments.live && arguments.images.empty() && arguments.recording.empty()) {
    return InvalidArgument(
        "nothing to calibrate from: name a recording, a folder with --images, or say --live");
  }
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
  AddLensOption(
      command, "--lens", arguments.lens,
      "Model of the lens, in a rig the thermal camera's: brown-conrady up to some 90 "
      "degrees of view, rational or fisheye for wider ones. If you do not know: the right "
      "one leaves the smallest reprojection error by far");
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

void AddDepthArguments(CLI::App& command, TargetArguments& arguments) {
  CLI::Option* infrared =
      command.add_flag("--infrared", arguments.infrared,
                       "The depth camera's images (--images) are infrared images, not depth");
  command
      .add_option(
          "--infrared-shift", arguments.infrared_shift_px,
          "By how much the principal point of infrared images exceeds that of depth images, "
          "pixels of images 640 wide. PrimeSense's compare windows of pixels and number "
          "depth by a corner of them; 0 0 if each depth pixel is an infrared pixel")
      ->expected(2)
      ->check(CLI::Range(-20.0, 20.0))
      ->needs(infrared)
      ->capture_default_str();
  command
      .add_option("--depth-scale", arguments.depth_scale,
                  "Units per metre of depth images in a folder")
      ->check(CLI::Range(1.0, 65535.0))
      ->capture_default_str();
}

void AddDepthLens(CLI::App& command, TargetArguments& arguments) {
  AddLensOption(command, "--depth-lens", arguments.depth_lens,
                "Model of the depth camera's lens, as --lens");
}

CalibratedStream DepthStream(const TargetArguments& arguments) {
  return arguments.infrared ? CalibratedStream::kInfrared : CalibratedStream::kDepth;
}

Result<std::vector<ImageSeries>> ReadSeries(const TargetArguments& arguments,
                                            const std::vector<CalibratedStream>& streams) {
  const Result<CalibrationTarget> target = ParseTarget(arguments.target);
  if (!target) return Err(target.error());
  if (Status status = CheckStreams(arguments, *target, streams); !status.ok()) return Err(status);
  if (arguments.live) {
    std::vector<std::string> names;
    for (const CalibratedStream stream : streams) names.emplace_back(ToString(stream));
    return TakeLiveSeries(arguments.address, *target, streams, LensesOf(arguments, names));
  }
  std::vector<ImageSeries> all;
  for (const CalibratedStream stream : streams) {
    ProgressBar bar(fmt::format("reading {} images", ToString(stream)), 0, "");
    const auto progress = [&](double fraction) { bar.Update(fraction); };
    const CalibrationStream read{stream, *target, arguments.depth_scale};
    Result<ImageSeries> series = arguments.images.empty()
                                     ? ReadStillPoses(arguments.recording, read, progress)
                                     : ReadImageFolder(arguments.images, read, progress);
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
  input.lenses = LensesOf(arguments, camera_names);
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
  for (CalibratedCamera& camera : report.cameras) {
    constexpr double kShiftWidth_px = 640.0;
    if (arguments.infrared && camera.name == "depth")
      camera.infrared_shift_px = camera.size_px.x() / kShiftWidth_px *
                                 Eigen::Vector2d::Map(arguments.infrared_shift_px.data());
  }
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
