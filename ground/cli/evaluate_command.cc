#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/progress.h"
#include "ground/cli/command.h"
#include "ground/cli/held_out_text.h"
#include "ground/cli/numbers.h"
#include "ground/cli/scan_arguments.h"
#include "ground/evaluation/result_evaluation.h"

namespace isotherm {
namespace {

constexpr const char* kEvaluateFooter =
    R"(Trajectory: positions of frames with the same stamp, after the rigid alignment that fits best
(no scale) and with the first poses made equal. Surface: distance of each point of cloud.ply to
the true surface, discs around its samples, with the first poses made equal and after a rigid
fit of the cloud. Temperature: measured minus the apparent temperature that the true
temperature, the emissivity and the surroundings imply, by class: good in distance, angle and
motion, acceptable, bad in one of them. Edges are places where true temperatures differ by more than 5 K
within 5 mm. Uncertainty: of the errors, 68.3 % should lie within the standard uncertainty that each
temperature has, 95 % within 1.96 times that.

With --held-out-views K a recording is reconstructed without every K-th of its thermal frames, and these
are compared with what the model shows from where they were taken: no truth is needed. Surfaces
look colder from the side; with --emissivity and --refractive-index the prediction says by how much.
Nothing is written.

Examples:
  isotherm evaluate out --groundtruth furnace/groundtruth.txt --surface furnace/surface.ply \
      --emissivity 0.96 --ambient 23
  isotherm evaluate scan.mcap --held-out-views 10)";

struct EvaluateArguments {
  EvaluationRequest request;
  std::string result_dir, groundtruth, surface, repeats, volume_box, rig;
  ScanArguments scan;  ///< With --held-out-views.
  std::optional<int> held_out_views;
  bool json = false;
};

Result<Eigen::AlignedBox3f> ParseBox(const std::string& text) {
  const auto numbers = ParseNumbers(text, {6}, "--volume-box");
  if (!numbers) return Err(numbers.error());
  const Eigen::Matrix<float, 6, 1> v =
      Eigen::Map<const Eigen::Matrix<double, 6, 1>>(numbers->data()).cast<float>();
  const Eigen::AlignedBox3f box(v.head<3>(), v.tail<3>());
  if (box.isEmpty())
    return Err(InvalidArgument("--volume-box: the second corner must not be below the first"));
  return box;
}

void Print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

/// Returns what the arguments say of the scanned surface; nullopt: nothing.
Result<std::optional<SmoothSurface>> SurfaceOf(const EvaluationRequest& request) {
  if (request.emissivity.has_value() != request.refractive_index.has_value()) {
    return Err(InvalidArgument(
        "--emissivity and --refractive-index say together how a prediction depends on the angle: "
        "give both or none"));
  }
  if (!request.emissivity) return std::optional<SmoothSurface>();
  return std::optional<SmoothSurface>(
      SmoothSurface{*request.emissivity, *request.refractive_index, request.ambient_celsius});
}

int RunHeldOut(const EvaluateArguments& arguments) {
  const int every = *arguments.held_out_views;
  if (every < 2) {
    return Fail(InvalidArgument(
        fmt::format("--held-out-views K keeps every K-th thermal frame out: K must be at least 2, "
                    "got {}",
                    every)));
  }
  if (std::error_code error; std::filesystem::is_directory(arguments.result_dir, error)) {
    return Fail(InvalidArgument(
        fmt::format("{}: is a folder; --held-out-views reconstructs a recording (.mcap)",
                    arguments.result_dir)));
  }
  const Result<std::optional<SmoothSurface>> surface = SurfaceOf(arguments.request);
  if (!surface) return Fail(surface.error());
  ReconstructRequest request;
  ScanArguments scan = arguments.scan;
  scan.recording = arguments.result_dir;
  scan.rig = arguments.rig;
  if (const int status = CollectScanOptions(scan, request); status != 0) return status;
  if (const Status status = FindScan(scan, request); !status.ok()) return Fail(status);
  std::optional<ProgressBar> progress;
  request.progress = [&](double fraction, std::string_view) {
    if (!progress) progress.emplace("reconstructing", 0, "");
    progress->Update(fraction);
  };
  const Result<HeldOutReport> report = PredictHeldOutViews(request, every, *surface);
  // After a failure the bar must not say 100 %.
  if (report && progress) progress->Finish();
  progress.reset();
  if (!report) return Fail(report.error());
  Print(arguments.json ? JsonText(ToJson(*report)) : ToText(*report));
  return 0;
}

int Run(const EvaluateArguments& arguments) {
  if (arguments.held_out_views) return RunHeldOut(arguments);
  if (arguments.groundtruth.empty()) {
    return Fail(InvalidArgument(
        "--groundtruth FILE is needed: the true poses (without truth: --held-out-views K)"));
  }
  EvaluationRequest request = arguments.request;
  request.result_dir = arguments.result_dir;
  request.groundtruth = arguments.groundtruth;
  if (!arguments.surface.empty()) request.surface = arguments.surface;
  if (!arguments.rig.empty()) request.rig = arguments.rig;
  if (!arguments.repeats.empty()) request.skip_repeats = arguments.repeats;
  if (!arguments.volume_box.empty()) {
    const auto box = ParseBox(arguments.volume_box);
    if (!box) return Fail(box.error());
    request.volume_box = *box;
  }
  if (request.emissivity && !request.surface) {
    return Fail(InvalidArgument("--emissivity needs --surface, which holds the true temperatures"));
  }
  std::optional<ProgressBar> progress;
  if (request.surface) progress.emplace("comparing", 0, "");  // With poses alone it takes no time.
  request.progress = [&progress](double fraction) { progress->Update(fraction); };
  const Result<EvaluationReport> report = Evaluate(request);
  if (!report) return Fail(report.error());
  if (progress) progress->Finish();
  Print(arguments.json ? JsonText(ToJson(*report)) : ToText(*report));
  return 0;
}

}  // namespace

void AddEvaluateCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("evaluate", "Compares a result with the truth");
  auto arguments = std::make_shared<EvaluateArguments>();
  EvaluationRequest& request = arguments->request;
  command
      ->add_option("folder", arguments->result_dir,
                   "Result folder with trajectory.txt and cloud.ply; with --held-out-views a "
                   "recording (.mcap)")
      ->required();
  CLI::Option* truth =
      command->add_option("--groundtruth", arguments->groundtruth,
                          "True poses: trajectory file, or recording with ground truth (.mcap)");
  CLI::Option* surface =
      command->add_option("--surface", arguments->surface,
                          "True surface (.ply: x y z nx ny nz scalar_temperature seen)");
  command->add_option("--emissivity", request.emissivity,
                      "Compare temperatures, for this emissivity (0..1) along the normal");
  command->add_option("--refractive-index", request.refractive_index,
                      "The emissivity falls with the angle of each measurement as that of a smooth "
                      "surface with this index");
  command->add_option(
      "--rig", arguments->rig,
      "Calibration (rig.textproto): also say how much of what the thermal camera saw "
      "well has a temperature; with --held-out-views, instead of the one in the recording");
  CLI::Option* held_out =
      command
          ->add_option("--held-out-views", arguments->held_out_views,
                       "Reconstruct without every K-th thermal frame and predict those")
          ->type_name("K")
          ->excludes(truth)
          ->excludes(surface);
  for (CLI::Option* option : AddScanOptions(*command, arguments->scan)) option->needs(held_out);
  command->add_option("--ambient", request.ambient_celsius, "Temperature of the surroundings, °C")
      ->capture_default_str();
  command
      ->add_option(
          "--volume-box", arguments->volume_box,
          "Count only true surface inside \"x y z x y z\" (two corners, the truth's world, metres)")
      ->excludes(held_out);
  command->add_option("--first", request.first, "Only the first N true poses")->excludes(held_out);
  command
      ->add_option("--skip-repeats", arguments->repeats,
                   "Leave out depth frames of this recording that repeat the one before")
      ->excludes(held_out);
  command
      ->add_option("--tolerance-ms", request.tolerance_ms,
                   "Largest difference between stamps of one frame")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Machine-readable output (metres, radians, kelvin)");
  command->footer(kEvaluateFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
