#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/progress.h"
#include "ground/cli/command.h"
#include "ground/evaluation/stamping_trial.h"

namespace isotherm {
namespace {

constexpr const char* kTimingFooter =
    R"(Simulated cameras of known drift send frames through a simulated transport with jitter; each method
stamps them, and its stamps are compared with the true exposures. One constant delay per method and
scenario is taken out, as a calibration would.

  usual        baseline of some milliseconds (two exponential waits of 1 ms), 2 % impulses up to 40 ms
  load bursts  also held up by 5 ms and exponential 10 ms, every frame of 10 s in 40 s
  exponential  baseline of one wait of 2 ms
  normal       normal baseline of 1 ms: no frame is ever quite undisturbed

The same seed gives the same table.

Examples:
  isotherm timing
  isotherm timing --seed 7 --runs 50)";

struct TimingArguments {
  StampingTrialOptions trial;
};

int Run(const TimingArguments& arguments) {
  const std::vector<StampingScenario> scenarios = StampingScenarios();
  constexpr double kRates_hz[] = {30.0, 40.0};
  std::string table =
      "rate  scenario     method            RMS ms  p99 ms  worst ms  within sigma\n";
  ProgressBar progress("simulating", 0, "");
  std::size_t done = 0;
  const std::size_t rows = std::size(kRates_hz) * scenarios.size() * kStampingMethods.size();
  for (const double rate_hz : kRates_hz) {
    for (const StampingScenario& scenario : scenarios) {
      for (const StampingMethod method : kStampingMethods) {
        StampingTrialOptions options = arguments.trial;
        options.rate_hz = rate_hz;
        const StampingResidual residual = RunStampingTrial(scenario, method, options);
        const std::string within = method == StampingMethod::kArrival
                                       ? "-"
                                       : fmt::format("{:.0f} %", 100.0 * residual.within_sigma);
        table += fmt::format("{:4.0f}  {:<11}  {:<15}  {:7.3f} {:7.3f}  {:8.3f}  {:>12}\n", rate_hz,
                             scenario.name, ToString(method), 1e3 * residual.rms_s,
                             1e3 * residual.p99_s, 1e3 * residual.worst_s, within);
        progress.Update(static_cast<double>(++done) / static_cast<double>(rows));
      }
    }
  }
  progress.Finish();
  fmt::print("residual of stamps against truth, after {:g} s; {} runs of {:g} s, seed {}\n{}",
             arguments.trial.skip_s, arguments.trial.runs, arguments.trial.duration_s,
             arguments.trial.seed, table);
  return 0;
}

}  // namespace

void AddTimingCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("timing", "How well capture times are estimated, by simulation");
  auto arguments = std::make_shared<TimingArguments>();
  command->add_option("--seed", arguments->trial.seed, "Of all noise")->capture_default_str();
  command->add_option("--runs", arguments->trial.runs, "Runs per row, each with a drift of its own")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command->add_option("--duration", arguments->trial.duration_s, "Of each run, seconds")
      ->check(CLI::Range(15.0, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--max-drift", arguments->trial.max_drift_ppm,
                   "The cameras' clocks are off by up to this, parts per million")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->footer(kTimingFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
