#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/progress.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/interpretation_arguments.h"
#include "ground/cli/model_export.h"
#include "ground/interpretation/interpretation.h"
#include "ground/results/result_folder.h"

namespace isotherm {
namespace {

constexpr const char* kExportFooter =
    R"(Temperatures in a model are apparent: those that black bodies would have. With an emissivity and the
temperature of what is reflected they become those of the objects (3.1, Planck over the camera's
band). DIR gets cloud.ply and mesh.ply with scalar_temperature (object) and
scalar_apparent_temperature, renders/*.png and stats.json.

A region is a box in `world`; it may have values of its own, and where regions overlap the later one
holds. A regions file has one entry each:
  region { name: "pipe" emissivity: 0.3 reflected_celsius: 25
           box { min { x_m: 0.1 y_m: 0.1 z_m: 0.7 } max { x_m: 0.3 y_m: 0.9 z_m: 0.8 } } }
With a material the emissivity is that at the angle at which each point was measured (Fresnel).
scalar_temperature_sigma is then that of the object's temperature, uncertainties of emissivity and
reflected temperature included; those are the same for all points of a part.
Points that were measured but fit no temperature are NaN, are counted, and make the exit status 65;
all files are written.

Examples:
  isotherm export out/model.iso -o out/objects --emissivity 0.85 --reflected 23
  isotherm export out/model.iso -o out/objects --emissivity 0.95 \
      --box "0.1 0.1 0.7 0.3 0.9 0.8: emissivity=0.3 reflected=25"
  isotherm export out/model.iso -o out/objects --emissivity 0.94 --emissivity-sigma 0.02 \
      --material paint
  isotherm export out/model.iso -o out/objects --regions plant.textproto --label "pipe: emissivity=0.4")";

struct ExportArguments {
  std::string model, output;
  ConfigurationArguments configuration;
  InterpretationArguments interpretation;
  std::optional<int> threads;
};

/// Values of single regions are left to Interpretation, which lets the rest go on.
GroundOptions CollectOptions(const ExportArguments& arguments, Problems& problems) {
  GroundOptions options;
  Apply(arguments.configuration, options, problems);
  if (arguments.threads) options.set_threads(*arguments.threads);
  problems.Add(ApplyArguments(arguments.interpretation, *options.mutable_interpretation()));
  if (!problems.empty()) return options;
  GroundOptions others = options;
  others.clear_interpretation();
  AddInvalid(others, problems);
  const Result<Interpretation> interpretation = Interpretation::Create(options.interpretation());
  if (!interpretation) problems.Add(interpretation.error());
  return options;
}

void PrintSummary(const Interpretation& interpretation, const ResultSummary& summary,
                  const std::string& folder) {
  fmt::print("surface  {} points, {} with a temperature; {} triangles\n", summary.points,
             summary.measured_points, summary.triangles);
  fmt::print("{}", AppliedText(interpretation, summary.interpretation));
  if (summary.measured_points > 0) {
    fmt::print("         {:.1f} to {:.1f} °C, mean {:.1f} °C (object temperature)\n",
               summary.temperatures.min_celsius, summary.temperatures.max_celsius,
               summary.temperatures.mean_celsius);
  }
  fmt::print("results  {}\n", folder);
}

int Run(const ExportArguments& arguments) {
  Problems problems;
  const GroundOptions options = CollectOptions(arguments, problems);
  if (!problems.empty()) return FailConfiguration(problems.text());
  const auto model = FindModel(arguments.model);
  if (!model) return Fail(model.error());
  const Interpretation interpretation = Interpretation::Create(options.interpretation()).value();
  ProgressBar progress("exporting", 0, "");
  const Result<ResultSummary> summary =
      ExportModel(*model, options, interpretation, arguments.output,
                  [&](std::string_view, double fraction) { progress.Update(fraction); });
  if (!summary) return Fail(summary.error());
  progress.Finish();
  PrintSummary(interpretation, *summary, arguments.output);
  return FailWhereUnsolved(interpretation, summary->interpretation);
}

}  // namespace

void AddExportCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand(
      "export", "Writes a saved model's results, with temperatures interpreted anew");
  auto arguments = std::make_shared<ExportArguments>();
  command->add_option("model", arguments->model, "Model (model.iso) or result folder")->required();
  command->add_option("-o,--output", arguments->output, "Folder for the results")->required();
  AddInterpretationOptions(*command, arguments->interpretation);
  command->add_option("--threads", arguments->threads, "Threads; 0 = one per core");
  AddConfigurationArguments(*command, arguments->configuration);
  command->footer(kExportFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
