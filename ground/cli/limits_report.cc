#include "ground/cli/limits_report.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

#include "common/base/units.h"
#include "common/radiometry/materials.h"

namespace isotherm {
namespace {

std::string Describe(const ErrorTolerance& tolerance) {
  return tolerance.in_kelvin ? fmt::format("{:g} K", tolerance.value)
                             : fmt::format("{:g} %", 100.0 * tolerance.value);
}

/// Limits that are cut to whole steps lie on the safe side. A value that is whole but for rounding
/// stays.
double RoundUp(double value, double step) {
  return value > 0.0 ? std::ceil(value / step - 1e-9) * step : 0.0;
}
double RoundDown(double value, double step) { return std::floor(value / step + 1e-9) * step; }

/// Returns 0 for what would be shown as -0.00.
double WithoutNegativeZero(double value) { return std::abs(value) < 0.005 ? 0.0 : value; }

}  // namespace

std::string ListMaterials(const SpectralBand& band) {
  // The emissivity of a band depends on temperature only through the weights within the band.
  constexpr double kTypical_celsius = 50.0;
  std::string text = fmt::format("{:<20}{:>6}  {:<26}{}\n", "material", "eps", "source", "what");
  for (const OpticalMaterial& material : OpticalMaterials()) {
    const BandEmissivity emissivity(material.index, band, kTypical_celsius);
    text += fmt::format("{:<20}{:>6.3f}  {:<26}{}\n", material.name, emissivity.At(0.0),
                        material.source, material.description);
  }
  text += fmt::format(
      "eps: emissivity along the normal of a smooth, opaque surface, {:g}-{:g} um. References and "
      "limits of\nvalidity are in docs/materials.md.\n",
      band.min_um, band.max_um);
  return text;
}

std::string DescribeCurve(const AngleRequest& request, const EmissionCurve& curve) {
  constexpr int kStep_deg = 5;
  std::string text = fmt::format(
      "{}, {:g}-{:g} um, object {:g} °C, reflected {:g} °C\n\n", request.name, request.band.min_um,
      request.band.max_um, request.conditions.object_celsius, request.conditions.reflected_celsius);
  text += "angle  emissivity   change     error\n";
  for (int degrees = 0; degrees < 90; degrees += kStep_deg) {
    const EmissionError error = curve.At(degrees * kRadPerDeg);
    text +=
        fmt::format("{:>4}°  {:>10.3f}  {:>+6.2f} %  {:>+6.2f} K\n", degrees, error.emissivity,
                    WithoutNegativeZero(100.0 * error.relative), WithoutNegativeZero(error.kelvin));
  }
  return text;
}

std::string DescribeLimits(const AngleRequest& request, const AngleLimits& limits) {
  std::string text = "\nemission angle (6.3b)\n";
  text += fmt::format("  good        up to {:.1f}°: error at most {}\n",
                      limits.good_rad / kRadPerDeg, Describe(request.good));
  text += fmt::format("  acceptable  up to {:.1f}°: error at most {}\n",
                      limits.max_rad / kRadPerDeg, Describe(request.acceptable));
  if (limits.min_rad > 0.0) {
    text += fmt::format("  bad         below {:.1f}°: the operator is mirrored\n",
                        limits.min_rad / kRadPerDeg);
  } else {
    text += "  the operator's mirror image costs less than that: no least angle\n";
  }
  return text;
}

std::string DescribeFootprints(double ifov_rad, const std::vector<double>& distances_m) {
  constexpr double kAngles_deg[] = {0.0, 30.0, 45.0, 60.0};
  std::string text =
      fmt::format("\na pixel sees {:.2f} mrad; on a surface, mm\ndistance", ifov_rad * 1e3);
  for (const double degrees : kAngles_deg) text += fmt::format("  at {:>2g}°", degrees);
  text += "\n";
  for (const double distance_m : distances_m) {
    text += fmt::format("{:>6.3f} m", distance_m);
    for (const double degrees : kAngles_deg) {
      text += fmt::format(
          "{:>8.2f}", FootprintOfPixel(ifov_rad, distance_m, degrees * kRadPerDeg).along_m * 1e3);
    }
    text += "\n";
  }
  return text;
}

std::string DescribeOptions(const LimitOptions& limits) {
  constexpr double kStep_m = 0.001;
  std::string set, config;
  // A line of the file and the overrides for one group of the thermal options.
  const auto add = [&](const char* group,
                       std::initializer_list<std::pair<const char*, std::optional<double>>> values,
                       int digits) {
    std::string fields;
    for (const auto& [name, value] : values) {
      if (!value) continue;
      set += fmt::format("{}--set thermal.{}.{}={:.{}f}", set.empty() ? "" : " ", group, name,
                         *value, digits);
      fields += fmt::format(" {}: {:.{}f}", name, *value, digits);
    }
    if (!fields.empty()) config += fmt::format("  {} {{{} }}\n", group, fields);
  };
  const auto round = [](std::optional<double> value, double (*direction)(double, double),
                        double step) {
    return value ? std::optional(direction(*value, step)) : std::nullopt;
  };
  add("distance",
      {{"min_m", round(limits.distance_min_m, RoundUp, kStep_m)},
       {"good_m", round(limits.distance_good_m, RoundDown, kStep_m)},
       {"max_m", round(limits.distance_max_m, RoundDown, kStep_m)}},
      3);
  if (limits.angle) {
    const AngleLimitsInDegrees angle = InTenthsOfDegrees(*limits.angle);
    add("angle",
        {{"min_deg", angle.min_deg}, {"good_deg", angle.good_deg}, {"max_deg", angle.max_deg}}, 1);
  }
  if (set.empty()) return {};
  return fmt::format("\non the command line\n  {}\nin the configuration file\nthermal {{\n{}}}\n",
                     set, config);
}

}  // namespace isotherm
