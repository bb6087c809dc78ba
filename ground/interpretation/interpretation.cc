#include "ground/interpretation/interpretation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/radiometry/materials.h"
#include "ground/options/ground_options.pb.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

constexpr const char* kWholeModel = "whole model";
// Larger ones say nothing of the surroundings, and are typing errors.
constexpr double kMaxReflectedSigma_k = 1000.0;
/// Beyond, nothing is measured, and Fresnel's emissivity goes to zero.
constexpr int kLastAngle_deg = 85;
/// Weighs the wavelengths of a material's index; the ratio hardly depends on it.
constexpr double kMaterial_celsius = 100.0;

/// Returns what is wrong with a part's numbers; `prefix` names it. Empty if nothing is.
std::string FindProblem(const InterpretedPart& part, bool has_emissivity,
                        const std::string& prefix) {
  if (!(part.emissivity > 0.0 && part.emissivity <= 1.0)) {
    return fmt::format("{}emissivity must be above 0 and at most 1, got {}", prefix,
                       part.emissivity);
  }
  if (!(part.reflected_celsius >= kMinRadiometric_celsius &&
        part.reflected_celsius <= kMaxRadiometric_celsius)) {
    return fmt::format("{}reflected_celsius must be {} to {} °C, got {}", prefix,
                       kMinRadiometric_celsius, kMaxRadiometric_celsius, part.reflected_celsius);
  }
  if (!(part.emissivity_sigma >= 0.0 && part.emissivity_sigma <= 1.0)) {
    return fmt::format("{}emissivity_sigma must be 0 to 1, got {}", prefix, part.emissivity_sigma);
  }
  if (!(part.reflected_sigma_k >= 0.0 && part.reflected_sigma_k <= kMaxReflectedSigma_k)) {
    return fmt::format("{}reflected_sigma_k must be 0 to {} K, got {}", prefix,
                       kMaxReflectedSigma_k, part.reflected_sigma_k);
  }
  if (!part.material.empty() && FindOpticalMaterial(part.material) == nullptr) {
    return fmt::format(
        "{}material '{}' is not known; `isotherm limits --list` shows those that are", prefix,
        part.material);
  }
  // Tables of ideal, clean materials are off by more than what the user wants to know along the
  // normal; only their dependence on the angle is used.
  if (!part.material.empty() && !has_emissivity) {
    return fmt::format(
        "{}material '{}' says how the emissivity depends on the angle; give the emissivity along "
        "the normal as well, measured (docs/materials.md)",
        prefix, part.material);
  }
  return {};
}

/// Sets what follows from a part's material.
void UseMaterial(const SpectralBand& band, InterpretedPart& part) {
  const OpticalMaterial* material = FindOpticalMaterial(part.material);
  if (material == nullptr) return;
  const BandEmissivity emissivity(material->index, band, kMaterial_celsius);
  const double along_normal = emissivity.At(0.0);
  for (int angle_deg = 0; angle_deg <= kLastAngle_deg; ++angle_deg)
    part.by_angle.push_back(
        static_cast<float>(emissivity.At(angle_deg * kRadPerDeg) / along_normal));
}

/// Returns a part's emissivity at an angle; NaN is along the normal.
double EmissivityAt(const InterpretedPart& part, float angle_deg) {
  if (part.by_angle.empty() || std::isnan(angle_deg)) return part.emissivity;
  const float at = std::clamp(angle_deg, 0.0F, static_cast<float>(kLastAngle_deg));
  // The last angle is interpolated from the entry before it.
  const auto first = std::min(static_cast<std::size_t>(at), part.by_angle.size() - 2);
  const float fraction = at - static_cast<float>(first);
  const float ratio =
      part.by_angle[first] + fraction * (part.by_angle[first + 1] - part.by_angle[first]);
  // A measured emissivity near 1 times a ratio above 1 would emit more than a black body.
  return std::min(1.0, part.emissivity * static_cast<double>(ratio));
}

std::string RegionPrefix(const std::string& name) {
  return fmt::format("interpretation.region '{}': ", name);
}

Status CheckBand(const InterpretationOptions& options) {
  // Outside of the visible and the far infrared the numbers are in another unit.
  constexpr double kMin_um = 0.5, kMax_um = 1000.0;
  const double from = options.expert().band_min_um(), to = options.expert().band_max_um();
  if (from >= kMin_um && to > from && to <= kMax_um) return OkStatus();
  return InvalidArgument(
      fmt::format("interpretation.expert.band_min_um and band_max_um must rise within {} to {} um, "
                  "got {} and {}",
                  kMin_um, kMax_um, from, to));
}

}  // namespace

Status Validate(const InterpretationOptions& options) {
  const Result<Interpretation> interpretation = Interpretation::Create(options);
  if (!interpretation) return interpretation.error();
  for (const InterpretedPart& part : interpretation->parts())
    if (!part.problem.empty()) return InvalidArgument(part.problem);
  return OkStatus();
}

Result<Interpretation> Interpretation::Create(const InterpretationOptions& options) {
  if (Status status = CheckBand(options); !status.ok()) return Err(status);
  Interpretation interpretation(
      SpectralBand{options.expert().band_min_um(), options.expert().band_max_um()});
  InterpretedPart whole;
  whole.name = kWholeModel;
  whole.emissivity = options.emissivity();
  whole.reflected_celsius = options.reflected_celsius();
  whole.material = options.material();
  whole.emissivity_sigma = options.emissivity_sigma();
  whole.reflected_sigma_k = options.reflected_sigma_k();
  if (std::string problem = FindProblem(whole, options.has_emissivity(), "interpretation.");
      !problem.empty())
    return Err(InvalidArgument(std::move(problem)));
  UseMaterial(interpretation.band_.band(), whole);
  interpretation.parts_.push_back(std::move(whole));
  for (const InterpretedRegion& region : options.region()) {
    InterpretedPart part;
    part.name =
        region.has_name() ? region.name() : fmt::format("region {}", interpretation.parts_.size());
    const Result<Eigen::AlignedBox3d> box = ToBox(region.box());
    if (!box) return Err(InvalidArgument(RegionPrefix(part.name) + box.error().message()));
    part.box_world = box->cast<float>();
    part.emissivity = region.has_emissivity() ? region.emissivity() : options.emissivity();
    part.reflected_celsius =
        region.has_reflected_celsius() ? region.reflected_celsius() : options.reflected_celsius();
    part.material = region.has_material() ? region.material() : options.material();
    part.emissivity_sigma =
        region.has_emissivity_sigma() ? region.emissivity_sigma() : options.emissivity_sigma();
    part.reflected_sigma_k =
        region.has_reflected_sigma_k() ? region.reflected_sigma_k() : options.reflected_sigma_k();
    part.problem = FindProblem(part, region.has_emissivity() || options.has_emissivity(),
                               RegionPrefix(part.name));
    if (part.problem.empty()) UseMaterial(interpretation.band_.band(), part);
    interpretation.parts_.push_back(std::move(part));
  }
  return interpretation;
}

bool Interpretation::changes_nothing() const {
  return std::ranges::all_of(parts_, [](const InterpretedPart& part) {
    return part.emissivity == 1.0 && part.by_angle.empty() && part.emissivity_sigma == 0.0 &&
           part.problem.empty();
  });
}

std::size_t Interpretation::PartAt(const Eigen::Vector3f& p_world) const {
  for (std::size_t i = parts_.size(); i-- > 1;)
    // Later regions lie over earlier ones, the whole model below all.
    if (parts_[i].box_world.contains(p_world)) return i;
  return 0;
}

double Interpretation::EmittedRadiance(const InterpretedPart& part, float apparent_celsius,
                                       float angle_deg) const {
  const double emissivity = EmissivityAt(part, angle_deg);
  return (band_.RadianceFromCelsius(static_cast<double>(apparent_celsius)) -
          (1.0 - emissivity) * band_.RadianceFromCelsius(part.reflected_celsius)) /
         emissivity;
}

float Interpretation::ObjectCelsius(std::size_t part, float apparent_celsius,
                                    float angle_deg) const {
  if (std::isnan(apparent_celsius) || !parts_[part].problem.empty()) return NAN;
  // Exactly as measured, not through two interpolations of the band's tables.
  if (EmissivityAt(parts_[part], angle_deg) == 1.0) return apparent_celsius;
  return static_cast<float>(
      band_.CelsiusFromRadiance(EmittedRadiance(parts_[part], apparent_celsius, angle_deg)));
}

float Interpretation::ObjectSigma(std::size_t index, float apparent_celsius, float apparent_sigma_k,
                                  float angle_deg) const {
  const InterpretedPart& part = parts_[index];
  const float object_celsius = ObjectCelsius(index, apparent_celsius, angle_deg);
  if (std::isnan(object_celsius) || std::isnan(apparent_sigma_k)) return NAN;
  const auto slope = [this](double celsius) {
    // The slope changes little within a kelvin, and radiances differ far above rounding.
    constexpr double kStep_k = 0.5;
    return (band_.RadianceFromCelsius(celsius + kStep_k) -
            band_.RadianceFromCelsius(celsius - kStep_k)) /
           (2.0 * kStep_k);
  };
  const double emissivity = EmissivityAt(part, angle_deg);
  const double emitted = band_.RadianceFromCelsius(static_cast<double>(object_celsius));
  const double reflected = band_.RadianceFromCelsius(part.reflected_celsius);
  // Of emitted = (measured - reflected) / emissivity + reflected, by each of the three.
  const double by_measured = slope(static_cast<double>(apparent_celsius)) *
                             static_cast<double>(apparent_sigma_k) / emissivity;
  // The emissivity along the normal is uncertain; at an angle by the same ratio.
  const double by_emissivity = (emitted - reflected) * part.emissivity_sigma / part.emissivity;
  const double by_reflected =
      (1.0 - emissivity) / emissivity * slope(part.reflected_celsius) * part.reflected_sigma_k;
  return static_cast<float>(std::hypot(by_measured, by_emissivity, by_reflected) /
                            slope(static_cast<double>(object_celsius)));
}

std::vector<PartReport> Interpretation::Apply(Surface& surface) const {
  std::vector<PartReport> reports(parts_.size());
  const double lowest_radiance = band_.RadianceFromCelsius(kMinRadiometric_celsius);
  for (CloudPoint& point : surface.points) {
    const std::size_t part = PartAt(point.position_m);
    PartReport& report = reports[part];
    ++report.points;
    point.apparent_celsius = point.celsius;
    if (std::isnan(point.celsius)) continue;
    ++report.measured;
    if (!parts_[part].by_angle.empty() && std::isnan(point.measured_angle_deg))
      ++report.without_angle;
    point.celsius = ObjectCelsius(part, point.apparent_celsius, point.measured_angle_deg);
    point.sigma_k =
        ObjectSigma(part, point.apparent_celsius, point.sigma_k, point.measured_angle_deg);
    if (!std::isnan(point.celsius) || !parts_[part].problem.empty()) continue;
    const float apparent = point.apparent_celsius;
    const bool first = report.unsolved() == 0;
    report.coldest_celsius = first ? apparent : std::min(report.coldest_celsius, apparent);
    report.hottest_celsius = first ? apparent : std::max(report.hottest_celsius, apparent);
    const bool cold =
        EmittedRadiance(parts_[part], apparent, point.measured_angle_deg) <= lowest_radiance;
    ++(cold ? report.reflects_too_much : report.too_hot);
  }
  return reports;
}

void Interpretation::Apply(const SurfaceMaps& maps, ViewMaps& view) const {
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      const Eigen::Vector3f p_world(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      if (std::isnan(view.celsius.At(x, y))) continue;
      float& sigma_k = view.sigma_k.At(x, y);
      sigma_k = ObjectSigma(PartAt(p_world), view.celsius.At(x, y), sigma_k,
                            view.measured_angle_deg.At(x, y));
    }
  }
  // Temperatures last: their sigmas depend on the apparent ones.
  Apply(maps, view, view.celsius);
}

void Interpretation::Apply(const SurfaceMaps& maps, const ViewMaps& view,
                           Image<float>& celsius) const {
  for (int y = 0; y < celsius.height(); ++y) {
    for (int x = 0; x < celsius.width(); ++x) {
      float& value = celsius.At(x, y);
      if (std::isnan(value)) continue;
      const Eigen::Vector3f p_world(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      value = ObjectCelsius(PartAt(p_world), value, view.measured_angle_deg.At(x, y));
    }
  }
}

std::vector<std::string> Interpretation::Overlaps() const {
  std::vector<std::string> sentences;
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    for (std::size_t j = i + 1; j < parts_.size(); ++j) {
      const Eigen::AlignedBox3f common = parts_[i].box_world.intersection(parts_[j].box_world);
      if (common.isEmpty() || !(common.volume() > 0.0F)) continue;
      sentences.push_back(
          fmt::format("regions '{}' and '{}' overlap: '{}', the later one, holds "
                      "where they do",
                      parts_[i].name, parts_[j].name, parts_[j].name));
    }
  }
  return sentences;
}

std::vector<std::string> Interpretation::Errors(const std::vector<PartReport>& reports) const {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const InterpretedPart& part = parts_[i];
    const PartReport& report = reports[i];
    if (!part.problem.empty()) {
      sentences.push_back(fmt::format("{}; its {} measured points get no temperature", part.problem,
                                      report.measured));
    } else if (report.without_angle > 0 && report.without_angle == report.measured) {
      sentences.push_back(fmt::format(
          "{}: the angle of no measured point is known, so that material '{}' counts as seen along "
          "its normal: scan with thermal.expert.records",
          part.name, part.material));
    } else if (report.unsolved() > 0) {
      // One sentence a part: the more frequent cause.
      const bool cold = report.reflects_too_much >= report.too_hot;
      sentences.push_back(fmt::format(
          "{}: {} of {} measured points ({:.1f} to {:.1f} °C apparent) get no temperature: with "
          "emissivity {} and {} °C reflected {}",
          part.name, report.unsolved(), report.measured, report.coldest_celsius,
          report.hottest_celsius, part.emissivity, part.reflected_celsius,
          cold ? "more would be reflected than was measured; raise emissivity or lower "
                 "reflected_celsius"
               : fmt::format("they would be hotter than {} °C; raise emissivity",
                             kMaxRadiometric_celsius)));
    }
  }
  return sentences;
}

Json Interpretation::Describe(const std::vector<PartReport>& reports) const {
  Json json;
  json["band_um"].push_back(band_.band().min_um);
  json["band_um"].push_back(band_.band().max_um);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Json part;
    part["name"] = parts_[i].name;
    if (i > 0) {
      for (const auto& corner : {parts_[i].box_world.min(), parts_[i].box_world.max()})
        for (const float coordinate : corner) part["box_m"].push_back(coordinate);
    }
    part["emissivity"] = parts_[i].emissivity;
    part["reflected_celsius"] = parts_[i].reflected_celsius;
    if (!parts_[i].material.empty()) {
      part["material"] = parts_[i].material;
      part["without_angle"] = reports[i].without_angle;
    }
    part["emissivity_sigma"] = parts_[i].emissivity_sigma;
    part["reflected_sigma_k"] = parts_[i].reflected_sigma_k;
    part["points"] = reports[i].points;
    part["measured_points"] = reports[i].measured;
    part["without_solution"] = reports[i].unsolved();
    if (!parts_[i].problem.empty()) part["refused_because"] = parts_[i].problem;
    json["parts"].push_back(std::move(part));
  }
  for (const std::string& sentence : Overlaps()) json["overlaps"].push_back(sentence);
  return json;
}

}  // namespace isotherm
