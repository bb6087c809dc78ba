#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/service.h"
#include "ground/cli/command.h"
#include "ground/cli/demo.h"
#include "ground/cli/simulation_files.h"

namespace isotherm {
namespace {

constexpr const char* kDemoFooter =
    R"(The simulated scan is rendered once and kept in the cache. isotherm-edge replays it as if it came
from cameras, isotherm-ground reconstructs it; both run as processes of their own and talk over DDS
on loopback. The summary compares the result with the simulation's truth. The exit status is 65 if a
frame was lost on the way.

Examples:
  isotherm demo
  isotherm demo --duration 10 --output /tmp/demo)";

struct DemoArguments {
  DemoRequest request;
  std::string output;
  bool headless = false;
};

int Run(const DemoArguments& arguments) {
  DemoRequest request = arguments.request;
  request.output = arguments.output;
  const StopSignal signal;
  const Result<DemoReport> report = RunDemo(request, signal.token());
  if (!report) return Fail(report.error());
  const std::string text = ToText(*report, request.output);
  std::fwrite(text.data(), 1, text.size(), stdout);
  const bool complete = report->depth.arrived == report->depth.simulated &&
                        report->thermal.arrived == report->thermal.simulated;
  return complete ? 0 : Fail(DataLoss("frames were lost on the way"));
}

}  // namespace

void AddDemoCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("demo", "Scans a simulated scene over DDS on this computer");
  auto arguments = std::make_shared<DemoArguments>();
  DemoRequest& request = arguments->request;
  arguments->output = request.output.string();
  command->add_option("--scene", request.scene, SceneNames())->capture_default_str();
  command->add_option("--duration", request.duration_s, "Length of the scan, seconds")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  command->add_option("--output", arguments->output, "Folder for the results")
      ->capture_default_str();
  command
      ->add_option("--rate", request.rate,
                   "1 = real time, 0 = as fast as this computer reconstructs")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--domain", request.domain, "DDS domain")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  command->add_flag("--headless", arguments->headless, "Open nothing, end when the scan is done");
  command->footer(kDemoFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
