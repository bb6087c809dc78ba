#include "ground/renderer/renderer.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "common/base/check.h"
#include "common/frame/frame.h"
#include "ground/ground_options.pb.h"
#include "ground/renderer/legend.h"

namespace isotherm {
namespace {

constexpr Rgb8 kGoodColour{0, 255, 0};
constexpr Rgb8 kAcceptableColour{255, 255, 0};
constexpr Rgb8 kBadColour{255, 0, 0};
constexpr Rgb8 kNeverMeasuredClassColour{0, 0, 0};
constexpr Rgb8 kGeometryColour{224, 226, 230};

/// Algorithm 7, line 12.
Rgb8 Shaded(Rgb8 colour, double brightness) {
  const auto scaled = [brightness](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(value * brightness));
  };
  return {scaled(colour.r), scaled(colour.g), scaled(colour.b)};
}

Rgb8 ClassColour(std::uint8_t condition) {
  switch (condition) {
    case static_cast<std::uint8_t>(ConditionClass::kGood):
      return kGoodColour;
    case static_cast<std::uint8_t>(ConditionClass::kAcceptable):
      return kAcceptableColour;
    case kNeverMeasured:
      return kNeverMeasuredClassColour;
    default:  // An unknown class is not to be trusted.
      return kBadColour;
  }
}

/// Calls `colour(x, y)` for each pixel with a surface.
template <typename Function>
RgbImage DrawSurface(const ViewMaps& view, const Function& colour) {
  RgbImage picture(view.width(), view.height(), kBackground);
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      if (view.HasSurface(x, y)) picture.At(x, y) = colour(x, y);
    }
  }
  return picture;
}

std::string Percent(std::size_t part, std::size_t whole) {
  if (whole == 0) return "";
  return fmt::format("{:.0f} % of view",
                     100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

}  // namespace

/// Words of one class layer's legend.
struct Renderer::Layer {
  std::string title, good, acceptable, bad;
};

Status Validate(const RendererOptions& options) {
  const double min = options.scale_min_celsius();
  const double max = options.scale_max_celsius();
  if (!std::isfinite(min) || !std::isfinite(max) || min >= max) {
    return InvalidArgument(fmt::format(
        "renderer.scale_min_celsius ({}) must be a number below renderer.scale_max_celsius ({})",
        min, max));
  }
  return OkStatus();
}

Renderer::Renderer(const RendererOptions& options, const ThermalOptions& thermal)
    : options_(std::make_unique<RendererOptions>(options)), colours_(options) {
  const auto metres = [](double from, double to) { return fmt::format("{:g}-{:g} m", from, to); };
  const auto degrees = [](double from, double to) {
    return fmt::format("{:g}-{:g}\u00B0", from, to);
  };
  distance_ = std::make_unique<Layer>(
      Layer{"measurement distance", metres(thermal.distance_min_m(), thermal.distance_good_m()),
            metres(thermal.distance_good_m(), thermal.distance_max_m()),
            fmt::format("< {:g} or > {:g} m", thermal.distance_min_m(), thermal.distance_max_m())});
  const std::string too_frontal =
      thermal.angle_min_deg() > 0.0 ? fmt::format("< {:g}\u00B0 or ", thermal.angle_min_deg()) : "";
  angle_ = std::make_unique<Layer>(
      Layer{"emission angle", degrees(thermal.angle_min_deg(), thermal.angle_good_deg()),
            degrees(thermal.angle_good_deg(), thermal.angle_max_deg()),
            too_frontal + fmt::format("> {:g}\u00B0", thermal.angle_max_deg())});
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

std::optional<TemperatureScale> Renderer::ScaleFor(const ViewMaps& view) const {
  return ChooseScale(*options_, Summarize(view.celsius.pixels()));
}

RgbImage Renderer::Thermal(const ViewMaps& view,
                           const std::optional<TemperatureScale>& scale) const {
  const bool shading = options_->shading();
  const RgbImage picture = DrawSurface(view, [&](int x, int y) {
    const double cos_view = shading ? view.cos_view.At(x, y) : 1.0;
    const double celsius = view.celsius.At(x, y);
    if (std::isnan(celsius) || !scale) return NeverMeasuredColour(x, y, cos_view);
    return Shaded(colours_.At(scale->Share(celsius)), cos_view);
  });
  if (!options_->legend()) return picture;
  return WithLegend(picture,
                    {"apparent temperature", scale, "scale: " + ScaleRuleName(*options_), true},
                    colours_);
}

RgbImage Renderer::Classes(const ViewMaps& view, const Image<std::uint8_t>& classes,
                           const Layer& layer) const {
  const bool shading = options_->shading();
  std::size_t good = 0, acceptable = 0, bad = 0, never = 0;
  const RgbImage picture = DrawSurface(view, [&](int x, int y) {
    const Rgb8 colour = ClassColour(classes.At(x, y));
    ++(colour == kGoodColour         ? good
       : colour == kAcceptableColour ? acceptable
       : colour == kBadColour        ? bad
                                     : never);
    return Shaded(colour, shading ? view.cos_view.At(x, y) : 1.0);
  });
  if (!options_->legend()) return picture;
  const std::size_t all = good + acceptable + bad + never;
  return WithLegend(picture,
                    {layer.title,
                     {{kGoodColour, "good", layer.good, Percent(good, all)},
                      {kAcceptableColour, "acceptable", layer.acceptable, Percent(acceptable, all)},
                      {kBadColour, "bad", layer.bad, Percent(bad, all)},
                      {kNeverMeasuredClassColour, "not measured", "", Percent(never, all)}}});
}

RgbImage Renderer::Distance(const ViewMaps& view) const {
  return Classes(view, view.distance_class, *distance_);
}

RgbImage Renderer::Angle(const ViewMaps& view) const {
  return Classes(view, view.angle_class, *angle_);
}

RgbImage Renderer::Geometry(const ViewMaps& view) const {
  return DrawSurface(view,
                     [&](int x, int y) { return Shaded(kGeometryColour, view.cos_view.At(x, y)); });
}

RgbImage RenderThermalFrame(const Image<std::uint16_t>& centikelvin,
                            const RendererOptions& options) {
  std::vector<float> celsius;
  celsius.reserve(centikelvin.size());
  bool all_measured = true;
  for (const std::uint16_t raw : centikelvin.pixels()) {
    celsius.push_back(raw == 0 ? kUnknownCelsius : CentikelvinToCelsius(raw));
    all_measured = all_measured && raw != 0;
  }
  const ColourTable colours(options);
  const std::optional<TemperatureScale> scale = ChooseScale(options, Summarize(celsius));
  RgbImage picture(centikelvin.width(), centikelvin.height());
  std::size_t i = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x, ++i) {
      picture.At(x, y) = std::isnan(celsius[i]) || !scale ? NeverMeasuredColour(x, y, 1.0)
                                                          : colours.At(scale->Share(celsius[i]));
    }
  }
  if (!options.legend()) return picture;
  return WithLegend(
      picture, {"apparent temperature", scale, "scale: " + ScaleRuleName(options), !all_measured},
      colours);
}

}  // namespace isotherm
