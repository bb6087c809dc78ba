#include "ground/export/interpretation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ground/options/ground_options.pb.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

constexpr const char* kWholeModel = "whole model";

/// Returns what is wrong with a part's numbers; `prefix` names it. Empty if nothing is.
std::string FindProblem(const InterpretedPart& part, const std::string& prefix) {
  if (!(part.emissivity > 0.0 && part.emissivity <= 1.0)) {
    return fmt::format("{}emissivity must be above 0 and at most 1, got {}", prefix,
                       part.emissivity);
  }
  if (!(part.reflected_celsius >= kMinRadiometric_celsius &&
        part.reflected_celsius <= kMaxRadiometric_celsius)) {
    return fmt::format("{}reflected_celsius must be {} to {} °C, got {}", prefix,
                       kMinRadiometric_celsius, kMaxRadiometric_celsius, part.reflected_celsius);
  }
  return {};
}

std::string RegionPrefix(const std::string& name) {
  return fmt::format("interpretation.region '{}': ", name);
}

Status CheckBand(const InterpretationOptions& options) {
  constexpr double kShortestUm = 0.5, kLongestUm = 1000.0;
  const double from = options.expert().band_min_um(), to = options.expert().band_max_um();
  if (from >= kShortestUm && to > from && to <= kLongestUm) return OkStatus();
  return InvalidArgument(
      fmt::format("interpretation.expert.band_min_um and band_max_um must rise within {} to {} um, "
                  "got {} and {}",
                  kShortestUm, kLongestUm, from, to));
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
  InterpretedPart whole{kWholeModel, {}, options.emissivity(), options.reflected_celsius(), {}};
  if (std::string problem = FindProblem(whole, "interpretation."); !problem.empty())
    return Err(InvalidArgument(std::move(problem)));
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
    part.problem = FindProblem(part, RegionPrefix(part.name));
    interpretation.parts_.push_back(std::move(part));
  }
  return interpretation;
}

bool Interpretation::changes_nothing() const {
  return std::ranges::all_of(parts_, [](const InterpretedPart& part) {
    return part.emissivity == 1.0 && part.problem.empty();
  });
}

std::size_t Interpretation::PartAt(const Eigen::Vector3f& p_world) const {
  for (std::size_t i = parts_.size(); i-- > 1;)
    if (parts_[i].box_world.contains(p_world)) return i;
  return 0;
}

double Interpretation::EmittedRadiance(const InterpretedPart& part, float apparent_celsius) const {
  return (band_.RadianceFromCelsius(static_cast<double>(apparent_celsius)) -
          (1.0 - part.emissivity) * band_.RadianceFromCelsius(part.reflected_celsius)) /
         part.emissivity;
}

float Interpretation::ObjectCelsius(std::size_t part, float apparent_celsius) const {
  if (std::isnan(apparent_celsius) || !parts_[part].problem.empty()) return NAN;
  if (parts_[part].emissivity == 1.0) return apparent_celsius;
  return static_cast<float>(
      band_.CelsiusFromRadiance(EmittedRadiance(parts_[part], apparent_celsius)));
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
    point.celsius = ObjectCelsius(part, point.apparent_celsius);
    if (!std::isnan(point.celsius) || !parts_[part].problem.empty()) continue;
    const float apparent = point.apparent_celsius;
    const bool first = report.unsolved() == 0;
    report.coldest_celsius = first ? apparent : std::min(report.coldest_celsius, apparent);
    report.hottest_celsius = first ? apparent : std::max(report.hottest_celsius, apparent);
    const bool cold = EmittedRadiance(parts_[part], apparent) <= lowest_radiance;
    ++(cold ? report.reflects_too_much : report.too_hot);
  }
  return reports;
}

void Interpretation::Apply(const SurfaceMaps& maps, Image<float>& celsius) const {
  for (int y = 0; y < celsius.height(); ++y) {
    for (int x = 0; x < celsius.width(); ++x) {
      float& value = celsius.At(x, y);
      if (std::isnan(value)) continue;
      const Eigen::Vector3f p_world(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      value = ObjectCelsius(PartAt(p_world), value);
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
    } else if (report.unsolved() > 0) {
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
