#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "common/base/output_file.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/interpretation_arguments.h"
#include "ground/cli/numbers.h"
#include "ground/measuring/shape_measurer.h"
#include "ground/measuring/shape_store.h"
#include "ground/model/load_model.h"
#include "ground/results/result_folder.h"

namespace isotherm {
namespace {

constexpr const char* kMeasureFooter =
    R"(SCAN is a result folder or a model.iso. Shapes are what was measured in the console: without --shapes, those of the
folder's shapes.json. The console measures with the same code, so the same model and shapes give the same numbers, bit for
bit. A ray reads the voxel record where it meets the surface first. How everything is measured: docs/measuring.md.

Emissivity and reflected temperature are those of the shapes; where they have none, those of the command line, of the
folder's configuration, or of a black body.

Examples:
  isotherm measure out/scan
  isotherm measure out/scan --shapes shapes.json --json values.json
  isotherm measure out/scan --ray "0.48 0.48 -0.3 0 0 1"
  isotherm measure out/scan --emissivity 0.95 --reflected 21)";

struct MeasureArguments {
  std::string scan, shapes, json;
  std::vector<std::string> rays;
  InterpretationArguments interpretation;
  ConfigurationArguments configuration;
};

/// The options that the scan was made with, as far as it tells, with those of the command line over
/// them.
GroundOptions CollectOptions(const MeasureArguments& arguments, const std::filesystem::path& model,
                             Problems& problems) {
  GroundOptions options = ConfigurationOf(model.parent_path()).value_or(GroundOptions());
  Apply(arguments.configuration, options, problems);
  problems.Add(ApplyArguments(arguments.interpretation, *options.mutable_interpretation()));
  return options;
}

Result<measuring::ShapeList> FindShapes(const MeasureArguments& arguments,
                                        const std::filesystem::path& model) {
  if (!arguments.shapes.empty()) return ReadShapes(arguments.shapes);
  if (!arguments.rays.empty()) return measuring::ShapeList();
  Result<measuring::ShapeList> shapes = ReadShapes(model.parent_path() / kShapesName);
  if (shapes || shapes.error().code() != StatusCode::kNotFound) return shapes;
  return Err(NotFound(shapes.error().message() +
                      ": nothing was measured in the console; --shapes names a file, --ray reads "
                      "a place"));
}

Result<measuring::Anchor> ParseRay(const std::string& text) {
  const auto numbers = ParseNumbers(text, {6}, "--ray");
  if (!numbers) return Err(numbers.error());
  measuring::Anchor anchor;
  const auto set = [&](std::size_t first, measuring::Vector3& v) {
    v.set_x((*numbers)[first]);
    v.set_y((*numbers)[first + 1]);
    v.set_z((*numbers)[first + 2]);
  };
  set(0, *anchor.mutable_origin());
  set(3, *anchor.mutable_direction());
  return anchor;
}

std::string StatisticsText(const measuring::Statistics& statistics) {
  return fmt::format("max {:.2f}, mean {:.2f}, min {:.2f} C, deviation {:.2f} K",
                     statistics.max_celsius(), statistics.mean_celsius(), statistics.min_celsius(),
                     statistics.deviation_k());
}

std::string RecordText(const measuring::VoxelRecord& record) {
  if (!record.hit()) return "nothing there";
  std::string text = record.has_object_celsius() ? fmt::format("{:.2f} C", record.object_celsius())
                                                 : "no temperature";
  if (record.has_object_sigma_k()) text += fmt::format(" +- {:.2f} K", record.object_sigma_k());
  text += ", " + record.quality();
  for (const std::string& reason : record.reasons()) text += "; " + reason;
  return text;
}

std::string ValueText(const measuring::MeasuredShape& measured) {
  if (!measured.problem().empty()) return measured.problem();
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (measured.has_record()) add(RecordText(measured.record()));
  if (measured.has_object()) add(StatisticsText(measured.object()));
  if (measured.has_difference_k()) add(fmt::format("difference {:.2f} K", measured.difference_k()));
  if (measured.area_m2() > 0.0) {
    add(fmt::format("{:.4f} m2, {:.0f} % measured well", measured.area_m2(),
                    100.0 * measured.quality().good()));
  }
  if (measured.length_m() > 0.0) add(fmt::format("{:.1f} mm", 1e3 * measured.length_m()));
  if (measured.has_heat_flow() && measured.heat_flow().measured_m2() > 0.0) {
    add(fmt::format("heat flow {:.2f} W, {:.2f} W of it by radiation",
                    measured.heat_flow().total_w(), measured.heat_flow().radiation_w()));
  }
  if (!measured.alarm().empty()) add("ALARM: " + measured.alarm());
  return text;
}

/// One line each on standard output.
void Print(const measuring::Measurements& all) {
  for (int i = 0; i < all.shapes_size(); ++i) {
    const measuring::Shape& shape = all.shapes(i);
    fmt::print("{:<16} {}\n", shape.name().empty() ? shape.id() : shape.name(),
               ValueText(all.measured(i)));
  }
}

Status AddRays(const MeasureArguments& arguments, ShapeMeasurer& measurer,
               measuring::Measurements& all) {
  for (const std::string& text : arguments.rays) {
    const Result<measuring::Anchor> ray = ParseRay(text);
    if (!ray) return ray.error();
    measuring::Shape& shape = *all.add_shapes();
    shape.set_name("ray");
    *shape.add_anchors() = *ray;
    *all.add_measured()->mutable_record() = measurer.Pick(*ray, {});
  }
  return OkStatus();
}

int Run(const MeasureArguments& arguments) {
  const auto path = FindModel(arguments.scan);
  if (!path) return Fail(path.error());
  Problems problems;
  GroundOptions options = CollectOptions(arguments, *path, problems);
  if (!problems.empty()) return FailConfiguration(problems.text());
  const Result<measuring::ShapeList> shapes = FindShapes(arguments, *path);
  if (!shapes) return Fail(shapes.error());
  const Result<LoadedModel> model = LoadModel(*path, options);
  if (!model) return Fail(model.error());
  ShapeMeasurer measurer(*model->tsdf, *model->thermal, RigidTransform::Identity(),
                         MakeMeasuringOptions(options, model->rig.thermal_sensor));
  measuring::Measurements all;
  *all.mutable_shapes() = shapes->shapes();
  for (measuring::MeasuredShape& measured : measurer.Measure(*shapes))
    *all.add_measured() = std::move(measured);
  if (const Status rays = AddRays(arguments, measurer, all); !rays.ok()) return Fail(rays);
  Print(all);
  if (arguments.json.empty()) return 0;
  const Status written = WriteFile(arguments.json, ExactJson(all));
  return written.ok() ? 0 : Fail(written);
}

}  // namespace

void AddMeasureCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("measure", "Measures spots, lines and areas on a finished scan");
  auto arguments = std::make_shared<MeasureArguments>();
  command->add_option("scan", arguments->scan, "Result folder or model (model.iso)")->required();
  command->add_option("--shapes", arguments->shapes, "File with shapes (shapes.json)");
  command->add_option(
      "--ray", arguments->rays,
      "Read the place where this ray meets the surface, \"x y z dx dy dz\" in world");
  command->add_option("--json", arguments->json, "Write all numbers into this file");
  AddInterpretationOptions(*command, arguments->interpretation);
  AddConfigurationArguments(*command, arguments->configuration);
  command->footer(kMeasureFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
