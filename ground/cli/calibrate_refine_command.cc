#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "common/base/output_file.h"
#include "common/base/progress.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "common/rig/rig_calibration_file.h"
#include "ground/calibration/calibration_check.h"
#include "ground/cli/calibrated_rig_file.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/frame_rendering.h"
#include "ground/cli/refinement_text.h"
#include "ground/cli/today.h"
#include "ground/export/png_file.h"
#include "ground/json/json.h"
#include "ground/offline/recording_refinement.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

constexpr const char* kRefineFooter =
    R"(Finds where the thermal camera sits and how it looks (pose to the depth camera, principal point, delay), and
what the radiation on other pixels adds to each one (thermal_sensor.scene_influence), from any scan of something
with warm and cold parts: the depth camera is tracked, and the thermal images must agree about each point of the
surface. No target is needed. A third of the scan is held out and must agree
better afterwards.

The calibration at hand is where the search begins, and what stays where the scan says nothing: --prior-...
says how far its values may be off (one standard deviation; 0 keeps a value). A scan of ten seconds in which
the rig is moved to and fro, nearer and farther, and turned about its view tells everything; a steady sweep
past a wall little. Uncertainties hold what drifting poses can be taken for.

Without --apply or --output nothing is written. All values are written together, for they are uncertain together;
comments of the file are lost, and as it was it is kept beside it (FILE.bak).

Examples:
  isotherm calibrate refine scan.mcap --rig rig.textproto --render refined.png
  isotherm calibrate refine scan.mcap --rig rig.textproto --apply
  isotherm calibrate refine scan.mcap --rig rig.textproto --prior-principal-point 0)";

constexpr const char* kCheckFooter =
    R"(Says, before a job, whether pose, delay and scene influence of the thermal camera are still what the calibration
says, from half a minute of scanning something with warm and cold parts: one line each. A fourth tells how
temperatures differ from one NUC to another, which calibrating does not help against, a fifth whether the depth
camera sees the surface the same all over its image. Exit status 0: all fit; 1: something has moved; 2: this scan
cannot tell (standard error says why).

Examples:
  isotherm calibrate check scan.mcap
  isotherm calibrate check scan.mcap --rig rig.textproto)";

// Exit statuses of the check.
constexpr int kMoved = 1, kCannotTell = 2;

struct RefineArguments {
  std::string recording, rig, output, render, json;
  double rotation_deg = 1.0, translation_mm = 10.0, delay_ms = 20.0, principal_point_px = 5.0;
  double influence_percent = 5.0;
  ConfigurationArguments configuration;
  bool apply = false, with_depth = false;
  int threads = 0;
};

/// Reads what the arguments name, refines, and shows the progress.
class RefineRun {
 public:
  explicit RefineRun(const RefineArguments& arguments) : arguments_(arguments) {}

  /// Returns an exit status if there is no result.
  std::optional<int> Refine() {
    Problems problems;
    Apply(arguments_.configuration, options_, problems);
    options_.set_threads(arguments_.threads);
    AddInvalid(options_, problems);
    if (!problems.empty()) return FailConfiguration(problems.text());
    RefinementInput input;
    input.recording = arguments_.recording;
    if (!arguments_.rig.empty()) {
      Result<Rig> rig = LoadRigCalibration(arguments_.rig);
      if (!rig) return Fail(rig.error());
      input.rig = std::move(*rig);
    }
    input.prior = {arguments_.rotation_deg * std::numbers::pi / 180.0,
                   1e-3 * arguments_.translation_mm, 1e-3 * arguments_.delay_ms,
                   arguments_.principal_point_px, 0.01 * arguments_.influence_percent};
    input.with_rendering = !arguments_.render.empty();
    input.with_depth = arguments_.with_depth;
    Result<RecordingRefinement> refined = [&] {
      ProgressBar bar("calibrating", 0, "");
      auto result =
          RefineByRecording(input, options_, [&](double fraction) { bar.Update(fraction); });
      if (result) bar.Finish();
      return result;
    }();
    if (!refined) {
      status_ = refined.error();
      return Fail(status_);
    }
    refined_ = std::move(*refined);
    verdict_ = Assess(refined_.refinement, LimitsOf(options_.calibration_check()));
    return std::nullopt;
  }

  const RecordingRefinement& refined() const { return refined_; }
  const CalibrationVerdict& verdict() const { return verdict_; }
  /// Why there is no result.
  const Status& status() const { return status_; }

 private:
  const RefineArguments& arguments_;
  GroundOptions options_;
  RecordingRefinement refined_;
  CalibrationVerdict verdict_;
  Status status_;
};

void SetInfluence(const SceneInfluence& found, RigCalibration& rig) {
  const bool is_calibrated = rig.thermal_sensor().has_scene_influence();
  if (!is_calibrated && found.Total() == 0.0) return;
  SceneInfluenceProperties& influence = *rig.mutable_thermal_sensor()->mutable_scene_influence();
  influence.set_near_fraction(found.near_fraction);
  influence.set_near_sigma_px(found.near_sigma_px);
  influence.set_total_fraction(found.total_fraction);
  // They were those of the influence before.
  if (!rig.has_radiometric_calibration()) return;
  rig.mutable_radiometric_calibration()->clear_parameters();
  rig.mutable_radiometric_calibration()->clear_covariance();
}

/// Changes what was refined, and says how.
void SetRefined(const RefineArguments& arguments, const RecordingRefinement& refined,
                RigCalibration& rig) {
  const Refinement& r = refined.refinement;
  rig.mutable_thermal()->set_cx(r.after.camera.cx);
  rig.mutable_thermal()->set_cy(r.after.camera.cy);
  *rig.mutable_t_thermal_depth() = ToProto(r.after.T_thermal_depth);
  rig.set_thermal_delay_s(refined.DelayAfter());
  SetInfluence(r.after.influence, rig);
  CalibrationRecord record;
  record.set_date(Today());
  record.set_method(fmt::format("{}, calibrate refine", SoftwareName()));
  record.set_target(fmt::format("scan {}", arguments.recording));
  record.set_views(static_cast<int>(r.frames));
  record.set_features(r.textured_points);
  record.set_uncertainty_px(r.shift.sigma_px);
  record.set_parameters(std::string(kPlacementParameterNames));
  SetCovariance(r.covariance, record);
  rig.set_date(record.date());
  rig.set_method(record.method());
  // It was that of other values.
  rig.clear_reprojection_error_px();
  *rig.mutable_pose_calibration() = record;
}

Status WriteExtras(const RefineArguments& arguments, const RefineRun& run) {
  if (!arguments.json.empty()) {
    ISOTHERM_RETURN_IF_ERROR(
        WriteFile(arguments.json, JsonText(RefinementJson(run.refined(), run.verdict()))));
    fmt::print("{}: written\n", arguments.json);
  }
  if (!arguments.render.empty()) {
    const RgbImage rendering =
        TemperatureRendering(BeforeAndAfter(run.refined()), "before and after");
    ISOTHERM_RETURN_IF_ERROR(WritePng(rendering, arguments.render));
    fmt::print("{}: the mean of all images on the surface, before (left) and after (right)\n",
               arguments.render);
  }
  return OkStatus();
}

int RunRefine(const RefineArguments& arguments) {
  RefineRun run(arguments);
  if (const std::optional<int> failed = run.Refine()) return *failed;
  fmt::print("{}", RefinementText(run.refined()));
  if (Status status = WriteExtras(arguments, run); !status.ok()) return Fail(status);
  if (!run.verdict().Moved()) {
    fmt::print("{}nothing to write{}\n", CheckText(run.refined(), run.verdict()),
               arguments.output.empty() ? "" : fmt::format(": {} is not made", arguments.output));
    return 0;
  }
  if (arguments.output.empty() && !arguments.apply) {
    fmt::print("nothing is written: --apply changes the file of --rig, --output writes another\n");
    return 0;
  }
  const Status written = WriteCalibratedRig(
      {arguments.rig, arguments.apply ? arguments.rig : arguments.output}, run.refined().rig,
      [&](RigCalibration& rig) { SetRefined(arguments, run.refined(), rig); });
  return written.ok() ? 0 : Fail(written);
}

int RunCheck(const RefineArguments& arguments) {
  RefineRun run(arguments);
  if (const std::optional<int> failed = run.Refine())
    return run.status().code() == StatusCode::kFailedPrecondition ? kCannotTell : *failed;
  fmt::print("{}", CheckText(run.refined(), run.verdict()));
  if (Status status = WriteExtras(arguments, run); !status.ok()) return Fail(status);
  const bool is_uneven = run.refined().depth->verdict == CheckVerdict::kMoved;
  if (is_uneven) fmt::print("see `isotherm calibrate depth-bias --help`\n");
  if (run.verdict().Moved())
    fmt::print("see `isotherm calibrate refine {}`\n", arguments.recording);
  if (is_uneven || run.verdict().Moved()) return kMoved;
  return run.verdict().Agrees() ? 0 : kCannotTell;
}

void AddPriorArguments(CLI::App& command, RefineArguments& arguments) {
  command
      .add_option("--prior-rotation", arguments.rotation_deg,
                  "Rotations may be off by this, degrees; 0 keeps them")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command
      .add_option("--prior-translation", arguments.translation_mm,
                  "Translations may be off by this, millimetres; 0 keeps them")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command
      .add_option("--prior-delay", arguments.delay_ms,
                  "The delay may be off by this, milliseconds; 0 keeps it")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command
      .add_option("--prior-principal-point", arguments.principal_point_px,
                  "The principal point may be off by this, pixels; 0 keeps it")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  command
      .add_option("--prior-influence", arguments.influence_percent,
                  "The scene's influence may be off by this, percent; 0 keeps it")
      ->check(CLI::Range(0.0, 25.0))
      ->capture_default_str();
}

void AddCommonArguments(CLI::App& command, RefineArguments& arguments) {
  command.add_option("recording", arguments.recording, "Recording (.mcap)")->required();
  AddConfigurationArguments(command, arguments.configuration);
  command.add_option("--threads", arguments.threads, "Threads; 0 = one per core");
  command.add_option("--json", arguments.json, "Write all values and their covariance (.json)");
  command.add_option("--render", arguments.render,
                     "Draw the surface with the mean of all images before and after (.png)");
  AddPriorArguments(command, arguments);
}

}  // namespace

void AddCalibrateRefineCommand(CLI::App& calibrate, CommandBody& body) {
  CLI::App* command = calibrate.add_subcommand(
      "refine",
      "Pose, principal point, delay and scene influence of the thermal camera from any scan");
  auto arguments = std::make_shared<RefineArguments>();
  AddCommonArguments(*command, *arguments);
  CLI::Option* rig_option = command->add_option("--rig", arguments->rig,
                                                "Calibration to refine; without, the recording's");
  CLI::Option* apply_option =
      command->add_flag("--apply", arguments->apply, "Change the file of --rig")->needs(rig_option);
  command
      ->add_option("-o,--output", arguments->output, "Write the refined calibration here instead")
      ->excludes(apply_option);
  command->footer(kRefineFooter);
  command->callback([arguments, &body] { body = [arguments] { return RunRefine(*arguments); }; });
}

void AddCalibrateCheckCommand(CLI::App& calibrate, CommandBody& body) {
  CLI::App* command = calibrate.add_subcommand(
      "check",
      "Whether pose, delay and scene influence of the thermal camera are still as calibrated");
  auto arguments = std::make_shared<RefineArguments>();
  arguments->with_depth = true;
  AddCommonArguments(*command, *arguments);
  command->add_option("--rig", arguments->rig, "Calibration to check; without, the recording's");
  command->footer(kCheckFooter);
  command->callback([arguments, &body] { body = [arguments] { return RunCheck(*arguments); }; });
}

}  // namespace isotherm
