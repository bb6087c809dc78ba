#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "common/base/units.h"
#include "common/options/nearest_name.h"
#include "common/radiometry/materials.h"
#include "common/rig/rig_calibration.h"
#include "ground/cli/command.h"
#include "ground/cli/limits_report.h"
#include "ground/cli/numbers.h"
#include "ground/cli/quantities.h"

namespace isotherm {
namespace {

constexpr const char* kLimitsFooter =
    R"(Angles: the emissivity of a smooth surface over the emission angle follows from its refractive index
(Fresnel), and from it the error of a temperature that is interpreted with the emissivity along the
normal. The tolerated error is a fraction of the radiance (2%) or a temperature (1.5K). Below the least
angle the surface mirrors the operator; there is one only where that matters. With nothing but --material
these are the limits that thermal.material sets.

Distances: sharp within the depth of field (focal length, f-number, focus, pitch; or --near and
--far), resolved while a detail is 1.5 pixels wide (good) or 1 (acceptable; --pixels "3 2" is stricter).

Examples:
  isotherm limits --list
  isotherm limits --material aluminium-oxidised --tolerance 2%
  isotherm limits --n 1.5 --k 0.1 --tolerance 2K --temperature 280 --reflected 23
  isotherm limits --focal-length 10mm --f-number 1 --focus 0.5m --pitch 25um --detail 2mm
  isotherm limits --rig rig.textproto --near 0.3m --far 0.9m --detail 2mm --at-angle 40)";

struct LimitsArguments {
  bool list = false;
  std::string material, band = "7.5 13", good_tolerance;
  std::string tolerance = fmt::format("{:g}%", 100.0 * kDefaultTolerance.value);
  std::optional<double> n;
  double k = 0.0;
  EmissionConditions conditions;
  std::string half_width = "0.3m", distance = "0.5m";
  std::string rig, focal_length, focus, pitch, detail, near, far;
  std::optional<double> f_number;
  double at_angle_deg = 0.0;
  std::string pixels = "1.5 1";

  bool AsksForAngles() const { return !material.empty() || n; }
  bool AsksForDistances() const {
    return !(rig.empty() && focal_length.empty() && near.empty() && far.empty());
  }
};

Status ReadTolerances(const LimitsArguments& arguments, AngleRequest& request) {
  const auto acceptable = ParseTolerance(arguments.tolerance, "--tolerance");
  if (!acceptable) return acceptable.error();
  request.acceptable = request.good = *acceptable;
  // Whoever gives one tolerance means the acceptable one.
  request.good.value *= kGoodFraction;
  if (arguments.good_tolerance.empty()) return OkStatus();
  const auto good = ParseTolerance(arguments.good_tolerance, "--good-tolerance");
  if (!good) return good.error();
  request.good = *good;
  return OkStatus();
}

Status ReadMaterial(const LimitsArguments& arguments, AngleRequest& request) {
  if (arguments.n) {
    if (!(*arguments.n > 0.0 && arguments.k >= 0.0))
      return InvalidArgument(fmt::format("--n must be positive and --k not negative, got {} and {}",
                                         *arguments.n, arguments.k));
    request.name = fmt::format("n {:g}, k {:g}", *arguments.n, arguments.k);
    request.index = {
        {(request.band.min_um + request.band.max_um) / 2.0, *arguments.n, arguments.k}};
    return OkStatus();
  }
  const OpticalMaterial* material = FindOpticalMaterial(arguments.material);
  if (material == nullptr) {
    std::vector<std::string> names;
    for (const OpticalMaterial& known : OpticalMaterials()) names.emplace_back(known.name);
    return InvalidArgument(fmt::format(
        "--material: there is no material '{}'.{} Known are {}; --n and --k take others",
        arguments.material, DidYouMean(arguments.material, names), JoinNames(names)));
  }
  request.name = fmt::format("{} ({})", material->name, material->description);
  request.index.assign(material->index.begin(), material->index.end());
  return OkStatus();
}

Result<SpectralBand> ReadBand(const LimitsArguments& arguments) {
  const auto numbers = ParseNumbers(arguments.band, {2}, "--band");
  if (!numbers) return Err(numbers.error());
  const SpectralBand band{(*numbers)[0], (*numbers)[1]};
  constexpr double kMin_um = 0.5, kMax_um = 1000.0;
  if (!(band.min_um >= kMin_um && band.max_um > band.min_um && band.max_um <= kMax_um)) {
    return Err(
        InvalidArgument(fmt::format("--band: expected two rising wavelengths of {} to {} um, "
                                    "got '{}'",
                                    kMin_um, kMax_um, arguments.band)));
  }
  return band;
}

Status CheckCelsius(double celsius, const char* option) {
  if (celsius >= kMinRadiometric_celsius && celsius <= kMaxRadiometric_celsius) return OkStatus();
  return InvalidArgument(fmt::format("{} must be {} to {} °C, got {}", option,
                                     kMinRadiometric_celsius, kMaxRadiometric_celsius, celsius));
}

Result<AngleRequest> ReadAngleRequest(const LimitsArguments& arguments, const SpectralBand& band) {
  AngleRequest request;
  request.band = band;
  request.conditions = arguments.conditions;
  const EmissionConditions& c = request.conditions;
  for (const Status& status : {ReadTolerances(arguments, request), ReadMaterial(arguments, request),
                               CheckCelsius(c.object_celsius, "--temperature"),
                               CheckCelsius(c.reflected_celsius, "--reflected"),
                               CheckCelsius(c.operator_celsius, "--operator")}) {
    if (!status.ok()) return Err(status);
  }
  const auto half_width = ParseLength(arguments.half_width, "--operator-half-width");
  const auto distance = ParseLength(arguments.distance, "--distance");
  for (const auto& length : {half_width, distance})
    if (!length) return Err(length.error());
  request.conditions.operator_half_width_m = *half_width;
  request.conditions.distance_m = *distance;
  return request;
}

/// Holds what is known of the optics; absent lengths were not given.
struct Optics {
  std::optional<double> ifov_rad, focal_length_m, pitch_m, focus_m, detail_m, near_m, far_m;
};

Result<Optics> ReadOptics(const LimitsArguments& arguments) {
  Optics optics;
  const auto read = [](const std::string& text, const char* option, std::optional<double>& length) {
    if (text.empty()) return OkStatus();
    const auto parsed = ParseLength(text, option);
    if (!parsed) return parsed.error();
    length = *parsed;
    return OkStatus();
  };
  for (const Status& status :
       {read(arguments.focal_length, "--focal-length", optics.focal_length_m),
        read(arguments.pitch, "--pitch", optics.pitch_m),
        read(arguments.focus, "--focus", optics.focus_m),
        read(arguments.detail, "--detail", optics.detail_m),
        read(arguments.near, "--near", optics.near_m),
        read(arguments.far, "--far", optics.far_m)}) {
    if (!status.ok()) return Err(status);
  }
  if (!arguments.rig.empty()) {
    const auto rig = LoadRigCalibration(arguments.rig);
    if (!rig) return Err(rig.error());
    if (!rig->thermal)
      return Err(FailedPrecondition(arguments.rig + ": the rig has no thermal camera"));
    // The calibrated focal length in pixels, since the nominal one of the lens is off by percents.
    optics.ifov_rad = 1.0 / rig->thermal->fx;
    if (!optics.focal_length_m && optics.pitch_m)
      optics.focal_length_m = rig->thermal->fx * *optics.pitch_m;
  } else if (optics.focal_length_m && optics.pitch_m) {
    optics.ifov_rad = *optics.pitch_m / *optics.focal_length_m;
  }
  return optics;
}

/// Given, or from the optics (2.20); without either, everything is sharp.
Result<DepthOfField> FindDepthOfField(const LimitsArguments& arguments, const Optics& optics) {
  DepthOfField field{0.0, HUGE_VAL};
  if (optics.focus_m) {
    if (!optics.focal_length_m || !optics.pitch_m || !arguments.f_number)
      return Err(
          InvalidArgument("--focus needs --focal-length (or --rig), --pitch and --f-number"));
    if (!(*arguments.f_number > 0.0) || *optics.focus_m <= *optics.focal_length_m) {
      return Err(InvalidArgument(fmt::format(
          "--f-number must be positive and --focus beyond the focal length, got {} and {} m",
          *arguments.f_number, *optics.focus_m)));
    }
    field = ComputeDepthOfField(*optics.focal_length_m, *arguments.f_number, *optics.pitch_m,
                                *optics.focus_m);
    fmt::print(
        "\nsharp from {:.3f} m to {:.3f} m; focused at {:.3f} m or more, to infinity (2.20)\n",
        field.near_m, field.far_m,
        HyperfocalDistance(*optics.focal_length_m, *arguments.f_number, *optics.pitch_m));
  }
  // Limits that were given replace those that follow from the lens.
  if (optics.near_m) field.near_m = *optics.near_m;
  if (optics.far_m) field.far_m = *optics.far_m;
  if (!(field.near_m < field.far_m)) {
    return Err(
        InvalidArgument(fmt::format("the limits contradict each other: nearest {} m, farthest {} m",
                                    field.near_m, field.far_m)));
  }
  return field;
}

Status RunDistances(const LimitsArguments& arguments, LimitOptions& options) {
  const Result<Optics> optics = ReadOptics(arguments);
  if (!optics) return optics.error();
  const Result<DepthOfField> field = FindDepthOfField(arguments, *optics);
  if (!field) return field.error();
  // Only limits that were found become options; the others keep their defaults.
  if (field->near_m > 0.0) options.distance_min_m = field->near_m;
  if (std::isfinite(field->far_m)) options.distance_max_m = field->far_m;
  std::vector<double> distances_m = {0.3, 0.5, 0.7, 1.0};
  if (optics->detail_m) {
    if (!optics->ifov_rad)
      return InvalidArgument("--detail needs --rig, or --focal-length and --pitch");
    const auto pixels = ParseNumbers(arguments.pixels, {2}, "--pixels");
    if (!pixels) return pixels.error();
    const auto limits =
        LimitDistances(*field, *optics->ifov_rad, *optics->detail_m,
                       arguments.at_angle_deg * kRadPerDeg, {pixels->front(), pixels->back()});
    if (!limits) return limits.error();
    options.distance_good_m = limits->good_m;
    options.distance_max_m = limits->max_m;
    distances_m = {limits->good_m, limits->max_m};
    if (limits->min_m > 0.0) distances_m.insert(distances_m.begin(), limits->min_m);
  }
  if (optics->ifov_rad) fmt::print("{}", DescribeFootprints(*optics->ifov_rad, distances_m));
  return OkStatus();
}

Status RunAngles(const LimitsArguments& arguments, const SpectralBand& band,
                 LimitOptions& options) {
  const Result<AngleRequest> request = ReadAngleRequest(arguments, band);
  if (!request) return request.error();
  const EmissionCurve curve(request->index, request->band, request->conditions);
  fmt::print("{}", DescribeCurve(*request, curve));
  const Result<AngleLimits> limits = curve.Limits(request->good, request->acceptable);
  if (!limits) return limits.error();
  fmt::print("{}", DescribeLimits(*request, *limits));
  options.angle = *limits;
  return OkStatus();
}

int Run(const LimitsArguments& arguments) {
  const Result<SpectralBand> band = ReadBand(arguments);
  if (!band) return Fail(band.error());
  if (arguments.list) {
    fmt::print("{}", ListMaterials(*band));
    return 0;
  }
  if (!arguments.AsksForAngles() && !arguments.AsksForDistances()) {
    return Fail(
        InvalidArgument("isotherm limits needs --material or --n for angles, or --rig, "
                        "--focal-length or --near for "
                        "distances (--help has examples)"));
  }
  LimitOptions options;
  if (arguments.AsksForAngles()) {
    if (const Status status = RunAngles(arguments, *band, options); !status.ok())
      return Fail(status);
  }
  if (arguments.AsksForDistances()) {
    if (const Status status = RunDistances(arguments, options); !status.ok()) return Fail(status);
  }
  fmt::print("{}", DescribeOptions(options));
  return 0;
}

void AddAngleOptions(CLI::App& command, LimitsArguments& arguments) {
  CLI::Option* material = command.add_option("--material", arguments.material,
                                             "Name from the list of materials (--list)");
  CLI::Option* n = command.add_option("--n", arguments.n, "Refractive index of another material")
                       ->excludes(material);
  command.add_option("--k", arguments.k, "Its extinction coefficient")
      ->needs(n)
      ->capture_default_str();
  command
      .add_option("--tolerance", arguments.tolerance,
                  "Error at the largest acceptable angle: 2% of the radiance, or 1.5K")
      ->capture_default_str();
  command.add_option("--good-tolerance", arguments.good_tolerance,
                     "Error at the largest good angle; a quarter of it if not given");
  EmissionConditions& conditions = arguments.conditions;
  command.add_option("--temperature", conditions.object_celsius, "Of the object, °C")
      ->capture_default_str();
  command.add_option("--reflected", conditions.reflected_celsius, "Of the surroundings, °C")
      ->capture_default_str();
  command.add_option("--operator", conditions.operator_celsius, "Of the operator and the rig, °C")
      ->capture_default_str();
  command
      .add_option("--operator-half-width", arguments.half_width,
                  "How far they reach to each side of the camera")
      ->capture_default_str();
  command.add_option("--distance", arguments.distance, "Between camera and surface, for that")
      ->capture_default_str();
  command.add_option("--band", arguments.band, "Of the thermal camera, \"min max\" um")
      ->capture_default_str();
}

void AddDistanceOptions(CLI::App& command, LimitsArguments& arguments) {
  command.add_option(
      "--rig", arguments.rig,
      "Calibration (rig.textproto) with the thermal camera's focal length in pixels");
  command.add_option("--focal-length", arguments.focal_length,
                     "Of the thermal camera's lens, 10mm");
  command.add_option("--f-number", arguments.f_number, "Focal length / aperture");
  command.add_option("--focus", arguments.focus, "Distance at which the lens is focused, 0.5m");
  command.add_option("--pitch", arguments.pitch, "Of the detector's elements, 25um");
  command.add_option("--detail", arguments.detail, "Smallest detail of interest, 4mm");
  command
      .add_option("--pixels", arguments.pixels,
                  "Width of a detail at the good and at the last acceptable distance")
      ->capture_default_str();
  command.add_option("--near", arguments.near, "Nearest sharp distance, instead of computing it");
  command.add_option("--far", arguments.far, "Farthest sharp distance");
  command
      .add_option("--at-angle", arguments.at_angle_deg,
                  "Emission angle at which details must still be resolved, degrees")
      ->check(CLI::Range(0.0, 89.0))
      ->capture_default_str();
}

}  // namespace

void AddLimitsCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("limits", "Derives limits of distance and emission angle (6.3)");
  auto arguments = std::make_shared<LimitsArguments>();
  command->add_flag("--list", arguments->list, "List the materials");
  AddAngleOptions(*command, *arguments);
  AddDistanceOptions(*command, *arguments);
  command->footer(kLimitsFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
