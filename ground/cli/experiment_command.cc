#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "ground/cli/command.h"
#include "ground/cli/simulation_files.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_output.h"

namespace isotherm {
namespace {

constexpr const char* kExperimentFooter =
    R"(Experiments repeat the thesis's figures on analytic scenes, whose truth is known, with the real
pipeline and simulated cameras. Each prints a table and what is required and measured; with -o it
writes NAME.csv, NAME.json and renderings (NAME_*.png). The exit status is 1 if a requirement is not
met.

Examples:
  isotherm experiment --list
  isotherm experiment parallax -o out/experiments
  isotherm experiment --all -o out/experiments)";

constexpr int kExitNotMet = 1;

struct ExperimentArguments {
  std::vector<std::string> names;
  std::string output;
  bool list = false, all = false;
  int threads = 0;
};

int List() {
  for (const Experiment& experiment : AllExperiments())
    fmt::print("{:<25}{:<20}{}\n", experiment.name, experiment.figure, experiment.claim);
  return 0;
}

Result<std::vector<const Experiment*>> Chosen(const ExperimentArguments& arguments) {
  std::vector<const Experiment*> chosen;
  if (arguments.all) {
    for (const Experiment& experiment : AllExperiments()) chosen.push_back(&experiment);
  }
  for (const std::string& name : arguments.names) {
    const Experiment* const experiment = FindExperiment(name);
    if (experiment == nullptr) {
      return Err(InvalidArgument(fmt::format(
          "there is no experiment '{}' (isotherm experiment --list names them all)", name)));
    }
    chosen.push_back(experiment);
  }
  if (chosen.empty()) {
    return Err(
        InvalidArgument("which experiment? Give a name, --all, or --list to see what there is"));
  }
  return chosen;
}

int Run(const ExperimentArguments& arguments) {
  if (arguments.list) return List();
  const auto chosen = Chosen(arguments);
  if (!chosen) return Fail(chosen.error());
  ThreadPool pool(ChosenThreads(arguments.threads));
  bool all_met = true;
  std::size_t number = 0;
  for (const Experiment* experiment : *chosen) {
    // Each takes 5 to 30 s, guidance and link longer; only guidance says how far it is.
    fmt::print(stderr, "experiment {} of {}: {} ...\n", ++number, chosen->size(), experiment->name);
    const Result<ExperimentReport> report = experiment->run(pool);
    if (!report) return Fail(report.error().WithContext(experiment->name));
    fmt::print("{}\n", ToText(*experiment, *report));
    std::fflush(stdout);
    all_met = all_met && report->AllMet();
    if (arguments.output.empty()) continue;
    if (Status status = WriteExperiment(*experiment, *report, arguments.output); !status.ok())
      return Fail(status);
  }
  if (!arguments.output.empty()) fmt::print("renderings and tables are in {}\n", arguments.output);
  return all_met ? 0 : kExitNotMet;
}

}  // namespace

void AddExperimentCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("experiment", "Shows what the method does where the truth is known");
  auto arguments = std::make_shared<ExperimentArguments>();
  command->add_option("name", arguments->names, "Experiments to run");
  command->add_option("-o,--output", arguments->output, "Folder for renderings and tables");
  command->add_flag("--list", arguments->list, "Say which there are");
  command->add_flag("--all", arguments->all, "Run all of them");
  command->add_option("--threads", arguments->threads, "Threads; 0 = one per core");
  command->footer(kExperimentFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
