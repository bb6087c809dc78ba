#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "common/base/output_file.h"
#include "common/base/progress.h"
#include "common/concurrency/thread_pool.h"
#include "common/dataset/text_lines.h"
#include "common/options/edit_field.h"
#include "common/rig/rig_calibration.h"
#include "ground/calibration/calibration_verdict.h"
#include "ground/calibration/find_delay.h"
#include "ground/calibration/image_motion.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/simulation_files.h"
#include "ground/offline/calibration_scan.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

constexpr const char* kCalibrateTimeFooter =
    R"(Finds thermal_delay_s, which is added to thermal stamps so that they mean the same moment as depth
stamps. The depth camera is tracked through the recording; then thermal images are projected onto the
surface at the poses that a delay puts them at, and the delay is sought at which they agree. The recording
should show a surface with clear thermal contrast for 10 s or more while the rig is moved back and forth.
Parts of the scan are resampled to say how certain the result is; to their spread comes what drifting poses
can be taken for, which reversals average out. Nothing is written if parts spread by more than --max-sigma, if
the calibration's delay agrees with the result (calibration_check.expert.max_shift_s), or if nearly any would.

--rig names the calibration that the scan was made with. Only --apply changes it: that one number, comments
and all else stay, and the file as it was is kept beside it (FILE.bak).

Calibrate with the estimator (timestamper.expert.estimator) that scans are made with.

Examples:
  isotherm calibrate time scan.mcap
  isotherm calibrate time scan.mcap --rig rig.textproto --apply
  isotherm calibrate time scan.mcap --rig rig.textproto --output rig_new.textproto)";

constexpr double kReadFraction = 0.8;

struct CalibrateTimeArguments {
  std::string recording, rig, output;
  ConfigurationArguments configuration;
  bool apply = false;
  int threads = 0;
  FindDelayOptions find;
};

GroundOptions CollectOptions(const CalibrateTimeArguments& arguments, Problems& problems) {
  GroundOptions options;
  Apply(arguments.configuration, options, problems);
  options.set_threads(arguments.threads);
  AddInvalid(options, problems);
  return options;
}

/// The text of the calibration with the new delay: that of the file if there is one, with all its
/// comments, else the recording's.
Result<std::string> CalibratedText(const CalibrateTimeArguments& arguments, const Rig& recorded,
                                   double delay_s) {
  std::string text = ToText(recorded);
  if (!arguments.rig.empty()) {
    const Result<std::string> file = ReadTextFile(arguments.rig);
    if (!file) return Err(file.error());
    text = *file;
  }
  text = WithFieldSet(text, "thermal_delay_s", fmt::format("{:.6g}", delay_s));
  // Never write what could not be read again.
  const Result<Rig> rig = ParseRigCalibration(text, arguments.rig);
  if (!rig) return Err(rig.error());
  return text;
}

/// Writes the calibration where it was asked for. A file that is changed in place keeps its old
/// content beside it.
Status WriteRig(const CalibrateTimeArguments& arguments, const std::string& text) {
  if (!arguments.output.empty()) {
    ISOTHERM_RETURN_IF_ERROR(WriteFile(arguments.output, text));
    fmt::print("{}: written\n", arguments.output);
    return OkStatus();
  }
  const Result<std::string> before = ReadTextFile(arguments.rig);
  if (!before) return before.error();
  const std::string backup = arguments.rig + ".bak";
  ISOTHERM_RETURN_IF_ERROR(WriteFile(backup, *before));
  ISOTHERM_RETURN_IF_ERROR(WriteFile(arguments.rig, text));
  fmt::print("{}: thermal_delay_s changed; as it was before: {}\n", arguments.rig, backup);
  return OkStatus();
}

/// Holds what a calibration says before and after.
struct Change {
  double before_s = 0.0;
  double after_s = 0.0;
};

/// Fails if it is not known which delay the stamps contain.
Result<Change> ChangeOf(const ScanForCalibration& scan, const std::optional<Rig>& rig,
                        double estimate_s) {
  const Result<double> delay_s = DelayInStamps(scan.applied_delay_s, rig);
  if (!delay_s) {
    return Err(FailedPrecondition(fmt::format("the stamps are off by {:+.1f} ms, but {}",
                                              1e3 * estimate_s, delay_s.error().message())));
  }
  const double applied_s = *delay_s;
  const double before_s = rig                ? rig->thermal_delay_s
                          : applied_s != 0.0 ? applied_s
                                             : scan.rig.thermal_delay_s;
  return Change{before_s, applied_s + estimate_s};
}

void Print(const ScanForCalibration& scan, const DelayEstimate& estimate, const Change& change) {
  fmt::print(
      "thermal_delay_s: {:.4f} ({:+.1f} ms), uncertain by {:.1f} ms (one standard deviation; "
      "{} parts of the scan)\n",
      change.after_s, 1e3 * change.after_s, 1e3 * estimate.sigma_s, estimate.parts);
  fmt::print(
      "images disagree {:.1f} times as much 15 ms away; {} thermal frames, {} surface "
      "points, {:.0f} px/s\n",
      estimate.contrast, scan.views.frames.size(), scan.views.points.size(),
      RmsSpeed(ImageVelocities(scan.views)));
  if (const std::string hint = HintOfDrift(estimate); !hint.empty()) fmt::print("{}\n", hint);
  if (scan.applied_delay_s.value_or(0.0) != 0.0) {
    fmt::print("of it, {:+.1f} ms were in the recording's stamps already\n",
               1e3 * *scan.applied_delay_s);
  }
  fmt::print("before: {:+.1f} ms, moved by {:+.1f} ms\n", 1e3 * change.before_s,
             1e3 * (change.after_s - change.before_s));
}

int Run(const CalibrateTimeArguments& arguments) {
  Problems problems;
  const GroundOptions options = CollectOptions(arguments, problems);
  if (!problems.empty()) return FailConfiguration(problems.text());
  std::optional<Rig> rig;
  if (!arguments.rig.empty()) {
    Result<Rig> loaded = LoadRigCalibration(arguments.rig);
    if (!loaded) return Fail(loaded.error());
    rig = std::move(*loaded);
  }
  std::optional<ProgressBar> bar;
  const auto progress = [&bar](double fraction) {
    if (!bar) bar.emplace("calibrating", 0, "");
    bar->Update(fraction);
  };
  const Result<ScanForCalibration> scan =
      ReadScan(arguments.recording, options, arguments.find.search.range_s,
               [&](double fraction) { progress(kReadFraction * fraction); });
  if (!scan) return Fail(scan.error());
  ThreadPool pool(ChosenThreads(arguments.threads));
  const Result<DelayEstimate> estimate = FindDelay(
      scan->views, arguments.find, pool,
      [&](double fraction) { progress(kReadFraction + (1.0 - kReadFraction) * fraction); });
  if (estimate && bar) bar->Finish();
  bar.reset();
  if (!estimate) return Fail(estimate.error().WithContext(arguments.recording));
  const Result<Change> change = ChangeOf(*scan, rig, estimate->delay_s);
  if (!change) return Fail(change.error().WithContext(arguments.recording));
  Print(*scan, *estimate, *change);
  DelayEstimate moved_by = *estimate;
  moved_by.delay_s = change->after_s - change->before_s;
  const CheckVerdict verdict = Assess(moved_by, options.calibration_check().expert().max_shift_s());
  if (verdict == CheckVerdict::kNotAssessed) {
    fmt::print("too uncertain to agree with the calibration or not: nothing to write\n");
    return 0;
  }
  if (verdict != CheckVerdict::kMoved) {
    fmt::print(
        "agrees with the calibration (within {:g} ms or its uncertainty): nothing to write\n",
        1e3 * options.calibration_check().expert().max_shift_s());
    return 0;
  }
  if (arguments.output.empty() && !arguments.apply) {
    if (!arguments.rig.empty())
      fmt::print("{} is not changed: --apply writes the delay into it\n", arguments.rig);
    return 0;
  }
  const double delay_s = std::round(1e6 * change->after_s) / 1e6;
  const Result<std::string> text = CalibratedText(arguments, scan->rig, delay_s);
  if (!text) return Fail(text.error());
  const Status written = WriteRig(arguments, *text);
  return written.ok() ? 0 : Fail(written);
}

}  // namespace

void AddCalibrateTimeCommand(CLI::App& calibrate, CommandBody& body) {
  CLI::App* command =
      calibrate.add_subcommand("time", "The constant delay between depth and thermal camera");
  auto arguments = std::make_shared<CalibrateTimeArguments>();
  command->add_option("recording", arguments->recording, "Recording (.mcap)")->required();
  CLI::Option* rig_option = command->add_option(
      "--rig", arguments->rig, "Calibration of the scan (text format of isotherm.RigCalibration)");
  command->add_option("--output", arguments->output,
                      "Write the calibration here instead; without --rig, the recording's");
  command->add_flag("--apply", arguments->apply, "Change the delay in the file of --rig")
      ->needs(rig_option);
  command
      ->add_option("--range", arguments->find.search.range_s,
                   "The delay is looked for up to this far to either side, seconds")
      ->check(CLI::Range(0.03, 1.0))
      ->capture_default_str();
  command
      ->add_option("--max-sigma", arguments->find.search.max_sigma_s,
                   "A result whose parts of the scan spread by more than this is refused, seconds")
      ->check(CLI::Range(0.0001, 0.1))
      ->capture_default_str();
  AddConfigurationArguments(*command, arguments->configuration);
  command->add_option("--threads", arguments->threads, "Threads; 0 = one per core");
  command->footer(kCalibrateTimeFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
