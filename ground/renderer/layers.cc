#include "ground/renderer/layers.h"

#include <algorithm>
#include <iterator>

namespace isotherm {
namespace {

constexpr RenderLayer kLayers[] = {
    RenderLayer::kThermal,     RenderLayer::kDistance,     RenderLayer::kAngle,
    RenderLayer::kMotion,      RenderLayer::kDisagreement, RenderLayer::kAge,
    RenderLayer::kUncertainty, RenderLayer::kCoverage,     RenderLayer::kGeometry};

}  // namespace

std::span<const RenderLayer> AllLayers() { return kLayers; }

std::string_view LayerName(RenderLayer layer) {
  switch (layer) {
    case RenderLayer::kThermal:
      return "thermal";
    case RenderLayer::kDistance:
      return "distance";
    case RenderLayer::kAngle:
      return "angle";
    case RenderLayer::kMotion:
      return "motion";
    case RenderLayer::kDisagreement:
      return "disagreement";
    case RenderLayer::kAge:
      return "age";
    case RenderLayer::kUncertainty:
      return "uncertainty";
    case RenderLayer::kCoverage:
      return "coverage";
    case RenderLayer::kGeometry:
      return "geometry";
  }
  return "";
}

std::optional<RenderLayer> LayerFromName(std::string_view name) {
  const auto* found = std::ranges::find(kLayers, name, &LayerName);
  return found == std::end(kLayers) ? std::nullopt : std::optional(*found);
}

}  // namespace isotherm
