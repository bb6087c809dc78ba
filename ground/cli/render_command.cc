#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>

#include "common/base/progress.h"
#include "common/geometry/pose_text.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/interpretation_arguments.h"
#include "ground/cli/model_renderings.h"
#include "ground/cli/numbers.h"
#include "ground/cli/simulation_files.h"
#include "ground/interpretation/interpretation.h"
#include "ground/renderer/palette.h"
#include "ground/renderer/renderer.h"
#include "ground/renderer/viewpoint.h"
#include "ground/results/result_folder.h"

namespace isotherm {
namespace {

constexpr const char* kRenderFooter =
    R"(MODEL is a model.iso, or a result folder of `isotherm reconstruct` with one in it; of a folder, the
limits of classes are those that it was made with. Without a view, the rendering shows the whole model
from where it was scanned. Places and poses are in `world`, in metres; a pose is T_world_camera,
x right, y down, z forward. All renderings of one call have the same colours for the same temperature.

Temperatures are apparent, those that black bodies would have, unless an emissivity is given: then they
are those of the objects, as `isotherm export` has them (which says more of regions). With a material the
emissivity is that at the angle at which each point was measured. What a result was made with does not
count. Points that were measured but fit no temperature look as if they were not, are counted, and make
the exit status 65; all renderings are written.

Layers: thermal       apparent temperature, or the objects': palette, isotherms, bands
        distance      class of the measurement distance
        angle         class of the emission angle
        motion        class of the smear while the temperature was measured
        disagreement  how far measurements contradict each other: reflections
        age           seconds between the last NUC and the measurement
        uncertainty   standard uncertainty of the temperature, kelvin
        coverage      what was seen by depth, but not measured well
        geometry      the surface only
Scales: min-max, 1-sigma, 3-sigma, percentile (2 to 98 %), 5..95% or, for fixed temperatures, 20..100
        (°C, or 68F..212F, 293K..373K)

Examples:
  isotherm render out -o door.png
  isotherm render out -o renderings --layer all
  isotherm render out -o door.png --palette inferno --scale 20..200 --isotherms "60, 100#00ff00"
  isotherm render out -o hot.png --bands "150.." --unit fahrenheit
  isotherm render out -o side.png --view-from "0.6 -0.2 -0.8" --look-at "0 0 0"
  isotherm render out -o orbit --orbit 36 --layer thermal,coverage
  isotherm render out -o paint.png --emissivity 0.94 --reflected 23 --material paint
  isotherm render out/model.iso -o last.png --view last --set renderer.expert.shading=false)";

struct RenderArguments {
  std::string model, output;
  ConfigurationArguments configuration;
  InterpretationArguments interpretation;
  std::vector<std::string> layers = {"thermal"};
  std::string view, from, at, up;
  std::optional<int> orbit;
  std::optional<double> arc_deg, elevation_deg;
  std::string size = "960x720";
  double fov_deg = 55.0;
  std::string palette, scale, unit, isotherms, bands;
  bool no_legend = false, no_shading = false;
  int threads = 0;
};

void SetLook(const RenderArguments& arguments, RendererOptions& options, Problems& problems) {
  if (!arguments.palette.empty()) {
    if (const auto palette = PaletteFromName(arguments.palette)) {
      options.set_palette(*palette);
    } else {
      problems.Add(InvalidArgument(fmt::format(
          "--palette: '{}' is none of coolwarm, iron, rainbow, grey, inferno", arguments.palette)));
    }
  }
  if (!arguments.unit.empty()) {
    constexpr std::pair<std::string_view, TemperatureUnit> kUnits[] = {
        {"celsius", CELSIUS}, {"fahrenheit", FAHRENHEIT}, {"kelvin", KELVIN},
        {"C", CELSIUS},       {"F", FAHRENHEIT},          {"K", KELVIN}};
    const auto* unit = std::ranges::find(kUnits, arguments.unit,
                                         &std::pair<std::string_view, TemperatureUnit>::first);
    if (unit != std::end(kUnits)) {
      options.set_unit(unit->second);
    } else {
      problems.Add(InvalidArgument(fmt::format(
          "--unit: '{}' is none of celsius, fahrenheit, kelvin, C, F, K", arguments.unit)));
    }
  }
  if (!arguments.scale.empty())
    problems.Add(ParseScale(arguments.scale, options).WithContext("--scale"));
  if (!arguments.isotherms.empty())
    problems.Add(ParseIsotherms(arguments.isotherms, options).WithContext("--isotherms"));
  if (!arguments.bands.empty())
    problems.Add(ParseBands(arguments.bands, options).WithContext("--bands"));
  if (arguments.no_legend) options.mutable_expert()->set_legend(false);
  if (arguments.no_shading) options.mutable_expert()->set_shading(false);
}

/// Takes the options of the result folder, then of the configuration file, then of the command
/// line.
GroundOptions CollectOptions(const RenderArguments& arguments, Problems& problems) {
  GroundOptions options;
  // Classes were assigned under the limits of that run: with other ones their legend would be
  // wrong.
  if (const auto made_with = ConfigurationOf(arguments.model)) {
    *options.mutable_renderer() = made_with->renderer();
    *options.mutable_thermal() = made_with->thermal();
    *options.mutable_export_() = made_with->export_();
  }
  Apply(arguments.configuration, options, problems);
  problems.Add(ApplyArguments(arguments.interpretation, *options.mutable_interpretation()));
  SetLook(arguments, *options.mutable_renderer(), problems);
  AddInvalid(options, problems);
  return options;
}

Result<std::vector<RenderLayer>> Layers(const std::vector<std::string>& names) {
  std::vector<RenderLayer> layers;
  for (const std::string& name : names) {
    if (name == "all") {
      layers.assign(AllLayers().begin(), AllLayers().end());
      return layers;
    }
    const auto layer = LayerFromName(name);
    if (!layer) {
      std::string known = "all";
      for (const RenderLayer each : AllLayers()) known += fmt::format(", {}", LayerName(each));
      return Err(InvalidArgument(
          fmt::format("--layer: there is no layer '{}'; there are {}", name, known)));
    }
    // "--layer thermal,thermal" must not write one file twice.
    if (std::ranges::count(layers, *layer) == 0) layers.push_back(*layer);
  }
  return layers;
}

Result<CameraModel> Camera(const RenderArguments& arguments) {
  constexpr int kMinSide_px = 16, kMaxSide_px = 8192;
  int width = 0, height = 0;
  const char* const end = arguments.size.data() + arguments.size.size();
  const auto [x, first_error] = std::from_chars(arguments.size.data(), end, width);
  const bool has_x = first_error == std::errc() && x != end && *x == 'x';
  if (!has_x || std::from_chars(x + 1, end, height).ptr != end ||
      std::min(width, height) < kMinSide_px || std::max(width, height) > kMaxSide_px) {
    return Err(InvalidArgument(
        fmt::format("--size: '{}' is not WIDTHxHEIGHT in pixels, {} to {} each, e.g. 960x720",
                    arguments.size, kMinSide_px, kMaxSide_px)));
  }
  constexpr double kMinFov_deg = 1.0, kMaxFov_deg = 150.0;
  if (!(arguments.fov_deg >= kMinFov_deg && arguments.fov_deg <= kMaxFov_deg)) {
    return Err(InvalidArgument(fmt::format("--fov must be {} to {} degrees, got {}", kMinFov_deg,
                                           kMaxFov_deg, arguments.fov_deg)));
  }
  return RenderingCamera(width, height, arguments.fov_deg);
}

Result<Eigen::Vector3d> Place(const std::string& text, const char* option,
                              const Eigen::Vector3d& otherwise) {
  if (text.empty()) return otherwise;
  const auto numbers = ParseNumbers(text, {3}, option);
  if (!numbers) return Err(numbers.error());
  return Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

/// Says where to look from, also in words.
struct Views {
  std::vector<RigidTransform> T_world_camera;
  std::string description;
};

Result<Views> OneView(const RenderArguments& arguments, const LoadedModel& model,
                      const std::vector<Eigen::Vector3f>& points_m, const ModelAspect& aspect,
                      const CameraModel& camera) {
  if (arguments.view == "last") {
    auto pose = LastPoseOf(arguments.model);
    if (!pose && !model.known_poses.empty()) pose = model.known_poses.back();
    if (!pose) {
      return Err(FailedPrecondition("--view last: the model knows no pose of the depth camera"));
    }
    return Views{{*pose}, "the depth camera's last pose"};
  }
  if (!arguments.view.empty()) {
    const auto pose = ParsePose(arguments.view);
    if (!pose) return Err(pose.error().WithContext("--view"));
    return Views{{*pose}, "as given"};
  }
  if (arguments.from.empty()) {
    // Nobody knows where the front of a scanned thing is, but it was scanned from there.
    return Views{{FrameAll(points_m, aspect.to_viewer_world, aspect.up_world, camera)},
                 "the whole model, from where it was scanned"};
  }
  const auto from = Place(arguments.from, "--view-from", aspect.centre_world);
  const auto at = Place(arguments.at, "--look-at", aspect.centre_world);
  if (!from) return Err(from.error());
  if (!at) return Err(at.error());
  const auto pose = LookAt(*from, *at, aspect.up_world);
  if (!pose) {
    return Err(InvalidArgument(
        "--view-from and --look-at are the same place, or one is right above the other: turn the "
        "camera with --up, or give a pose with --view"));
  }
  return Views{{*pose}, arguments.at.empty() ? "towards the model's centre" : "as given"};
}

Result<Views> OrbitViews(const RenderArguments& arguments,
                         const std::vector<Eigen::Vector3f>& points_m, const ModelAspect& aspect,
                         const CameraModel& camera) {
  // A surface has no back: from behind there is nothing to see.
  constexpr double kOneSidedArc_deg = 120.0;
  OrbitOptions orbit;
  orbit.count = *arguments.orbit;
  orbit.arc_deg = arguments.arc_deg.value_or(aspect.one_sided ? kOneSidedArc_deg : 360.0);
  orbit.elevation_deg = arguments.elevation_deg;
  const bool shortened = !arguments.arc_deg && aspect.one_sided;
  return Views{
      Orbit(points_m, aspect, camera, orbit),
      fmt::format("{} views over {:g}\u00B0{}", orbit.count, orbit.arc_deg,
                  shortened ? ", for it was scanned from one side (--arc 360: all around)" : "")};
}

Result<Views> ChooseViews(const RenderArguments& arguments, const LoadedModel& model,
                          const std::vector<Eigen::Vector3f>& points_m, const CameraModel& camera) {
  ModelAspect aspect = AspectOf(points_m, model.known_poses);
  const auto up = Place(arguments.up, "--up", aspect.up_world);
  if (!up) return Err(up.error());
  if (!(up->norm() > 0.0)) return Err(InvalidArgument("--up must have a length"));
  aspect.up_world = up->normalized();
  return arguments.orbit ? OrbitViews(arguments, points_m, aspect, camera)
                         : OneView(arguments, model, points_m, aspect, camera);
}

void PrintSummary(const Views& views, const GroundOptions& options,
                  const std::optional<TemperatureScale>& scale,
                  const std::vector<std::filesystem::path>& files) {
  fmt::print("view     {}\n", views.description);
  if (views.T_world_camera.size() == 1) {
    const RigidTransform& pose = views.T_world_camera.front();
    const Eigen::Vector3d p = pose.translation();
    const Eigen::Quaterniond q(pose.linear());
    fmt::print("         --view \"{:.4f} {:.4f} {:.4f} {:.6f} {:.6f} {:.6f} {:.6f}\"\n", p.x(),
               p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  if (scale) {
    const DisplayUnit unit = DisplayUnitOf(options.renderer().unit());
    fmt::print("scale    {:.1f} to {:.1f} {} ({}), {}\n", unit.Of(scale->min_celsius),
               unit.Of(scale->max_celsius), unit.name, ScaleRuleName(options.renderer()),
               PaletteName(options.renderer().palette()));
  } else {
    fmt::print("scale    none: the model has no temperatures\n");
  }
  fmt::print("renderings {}", files.front().string());
  if (files.size() > 1) fmt::print(" ... {} ({})", files.back().filename().string(), files.size());
  fmt::print("\n");
}

int Run(const RenderArguments& arguments) {
  const auto file = FindModel(arguments.model);
  if (!file) return Fail(file.error());
  const auto layers = Layers(arguments.layers);
  if (!layers) return Fail(layers.error());
  const auto camera = Camera(arguments);
  if (!camera) return Fail(camera.error());
  Problems problems;
  GroundOptions options = CollectOptions(arguments, problems);
  if (!problems.empty()) return FailConfiguration(problems.text());

  const auto model = LoadModel(*file, options);
  if (!model) return Fail(model.error());
  ThreadPool pool(ChosenThreads(arguments.threads));
  const Interpretation all = Interpretation::Create(options.interpretation()).value();
  const Interpretation* const interpretation = all.changes_nothing() ? nullptr : &all;
  const ModelSurface surface = SurfaceOf(*model, options, interpretation, pool);
  if (surface.points_m.empty()) {
    return Fail(DataLoss(file->string() + ": the model has no surface that was seen often enough "
                                          "(export.expert.min_weight)"));
  }
  // Views are chosen by what will be shown, so the surface is extracted before.
  const auto views = ChooseViews(arguments, *model, surface.points_m, *camera);
  if (!views) return Fail(views.error());
  const RenderingRequest request{*layers, views->T_world_camera, *camera, arguments.output,
                                 interpretation};
  if (const Status status = PrepareRenderings(request); !status.ok()) return Fail(status);
  // One scale for all views: a colour must mean the same temperature in all renderings of a call.
  const auto scale = ChooseScale(options.renderer(), surface.celsius);
  const std::vector<std::filesystem::path> files = RenderingFiles(request);
  std::optional<ProgressBar> progress;
  if (files.size() > 1) progress.emplace("rendering", files.size(), "renderings");
  const auto empty = WriteRenderings(*model, options, scale, request, pool, [&](double fraction) {
    if (progress) progress->Update(fraction);
  });
  // After a failure the bar must not say 100 %.
  if (empty && progress) progress->Finish();
  progress.reset();
  if (!empty) return Fail(empty.error());
  fmt::print("model    {}: {} points, voxels {:g} mm\n", file->string(), surface.points_m.size(),
             1e3 * options.volume().voxel_size_m());
  if (interpretation != nullptr) fmt::print("{}", AppliedText(all, surface.interpretation));
  PrintSummary(*views, options, scale, files);
  // A view beside the model is no failure: orbits and scripts have some. But it is said.
  if (*empty > 0) {
    fmt::print(stderr, "isotherm: {} of {} views show nothing of the model\n", *empty,
               views->T_world_camera.size());
  }
  return interpretation == nullptr ? 0 : FailWhereUnsolved(all, surface.interpretation);
}

void AddViewOptions(CLI::App& command, RenderArguments& arguments) {
  CLI::Option* view =
      command.add_option("--view", arguments.view,
                         "Pose of the camera, \"x y z qx qy qz qw\", or `last`: of the scan");
  CLI::Option* from =
      command.add_option("--view-from", arguments.from, "Where the camera stands, \"x y z\"")
          ->excludes(view);
  command.add_option("--look-at", arguments.at, "What it looks at; default: the model's centre")
      ->needs(from);
  command.add_option("--up", arguments.up,
                     "Direction that is up in the rendering, \"x y z\"; default: as in the scan");
  CLI::Option* orbit =
      command.add_option("--orbit", arguments.orbit, "That many views around the model")
          ->check(CLI::Range(1, 999))
          ->excludes(view)
          ->excludes(from);
  command
      .add_option("--arc", arguments.arc_deg,
                  "Degrees of the orbit; default: 360, or 120 if one side only was scanned")
      ->check(CLI::Range(0.0, 360.0))
      ->needs(orbit);
  command
      .add_option("--elevation", arguments.elevation_deg, "Of the orbit above the model, degrees")
      ->check(CLI::Range(-89.0, 89.0))
      ->needs(orbit);
  command.add_option("--size", arguments.size, "Pixels, without the legend")->capture_default_str();
  command.add_option("--fov", arguments.fov_deg, "Angle from left to right, degrees")
      ->capture_default_str();
}

}  // namespace

void AddRenderCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("render", "Makes renderings of a saved model");
  auto arguments = std::make_shared<RenderArguments>();
  command->add_option("model", arguments->model, "Model (model.iso) or result folder")->required();
  command->add_option("-o,--output", arguments->output, "Rendering (.png), or folder for several")
      ->required();
  command->add_option("--layer", arguments->layers, "What to show: layers, or all")
      ->delimiter(',')
      ->capture_default_str();
  AddViewOptions(*command, *arguments);
  command->add_option("--palette", arguments->palette, "coolwarm, iron, rainbow, grey or inferno");
  command->add_option("--scale", arguments->scale, "What the colours stand for, see below");
  command->add_option("--unit", arguments->unit, "Of legends: celsius, fahrenheit or kelvin");
  command->add_option("--isotherms", arguments->isotherms,
                      "Lines of equal temperature: \"60, 80#00ff00\"");
  command->add_option(
      "--bands", arguments->bands,
      "Painted (\"80..100#ff00ff\") or, without a colour, highlighted temperatures");
  AddInterpretationOptions(*command, arguments->interpretation);
  command->add_flag("--no-legend", arguments->no_legend, "The view only");
  command->add_flag("--no-shading", arguments->no_shading, "The same brightness at every angle");
  AddConfigurationArguments(*command, arguments->configuration);
  command->add_option("--threads", arguments->threads, "Threads; 0 = one per core");
  command->footer(kRenderFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
