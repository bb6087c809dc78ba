#include "ground/renderer/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/base/quantile.h"

namespace isotherm {
namespace {

// The classes have the colours of a traffic light, as in the thesis.
constexpr Rgb8 kGoodColour{0, 255, 0};
constexpr Rgb8 kAcceptableColour{255, 255, 0};
constexpr Rgb8 kBadColour{255, 0, 0};
constexpr Rgb8 kNeverMeasuredClassColour{0, 0, 0};
constexpr Rgb8 kUncheckedColour{96, 84, 128};
constexpr Rgb8 kGeometryColour{224, 226, 230};
// Coverage: what is done recedes, what is missing shines.
constexpr Rgb8 kMeasuredWellColour{186, 192, 196};
constexpr Rgb8 kMeasuredAcceptablyColour{120, 140, 150};
constexpr Rgb8 kOnlyBadlyColour{255, 150, 0};
constexpr Rgb8 kMissingColour{255, 0, 200};
// A dark edge of this width on both sides keeps isotherms visible on light colours.
constexpr double kCasing_px = 1.0;
constexpr Rgb8 kCasingColour{16, 18, 22};
constexpr double kCasingOpacity = 0.6;

/// Algorithm 7, line 12.
Rgb8 Shaded(Rgb8 colour, double brightness) {
  const auto scaled = [brightness](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(value * brightness));
  };
  return {scaled(colour.r), scaled(colour.g), scaled(colour.b)};
}

Rgb8 Mixed(Rgb8 from, Rgb8 to, double fraction) {
  const auto mix = [fraction](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + fraction * (b - a)));
  };
  return {mix(from.r, to.r), mix(from.g, to.g), mix(from.b, to.b)};
}

/// Without its colour, as bright as before (luma of ITU-R BT.601).
Rgb8 Greyed(Rgb8 colour) {
  const auto value = static_cast<std::uint8_t>(
      std::lround(0.299 * colour.r + 0.587 * colour.g + 0.114 * colour.b));
  return {value, value, value};
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
  RgbImage rendering(view.width(), view.height(), kBackground);
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      if (view.HasSurface(x, y)) rendering.At(x, y) = colour(x, y);
    }
  }
  return rendering;
}

/// Fills in the legend's fractions by counting the rows' colours among those that `colour(x, y)`
/// gives.
template <typename Function>
void CountFractions(const ViewMaps& view, const Function& colour, ClassLegend& legend) {
  std::vector<std::size_t> counts(legend.rows.size(), 0);
  std::size_t all = 0;
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      if (!view.HasSurface(x, y)) continue;
      ++all;
      const Rgb8 pixel = colour(x, y);
      for (std::size_t i = 0; i < counts.size(); ++i) {
        // Colours stand for classes, before shading changes them.
        if (legend.rows[i].colour == pixel) ++counts[i];
      }
    }
  }
  for (std::size_t i = 0; i < counts.size() && all > 0; ++i) {
    legend.rows[i].fraction = fmt::format(
        "{:.0f} % of view", 100.0 * static_cast<double>(counts[i]) / static_cast<double>(all));
  }
}

void DrawLine(const Image<float>& cover, Rgb8 colour, double opacity, RgbImage& rendering) {
  for (int y = 0; y < rendering.height(); ++y) {
    for (int x = 0; x < rendering.width(); ++x) {
      const double fraction = opacity * static_cast<double>(cover.At(x, y));
      if (fraction > 0.0) rendering.At(x, y) = Mixed(rendering.At(x, y), colour, fraction);
    }
  }
}

ClassLegend LegendOfClasses(std::string title, std::string good, std::string acceptable,
                            std::string bad) {
  return {std::move(title),
          {{kGoodColour, "good", std::move(good), ""},
           {kAcceptableColour, "acceptable", std::move(acceptable), ""},
           {kBadColour, "bad", std::move(bad), ""},
           {kNeverMeasuredClassColour, "not measured", "", ""}}};
}

std::string BandName(const TemperatureBand& band, const DisplayUnit& unit) {
  const auto written = [&](double celsius) { return fmt::format("{:.4g}", unit.Of(celsius)); };
  if (std::isinf(band.from_celsius))
    return fmt::format("up to {} {}", written(band.to_celsius), unit.name);
  if (std::isinf(band.to_celsius))
    return fmt::format("from {} {}", written(band.from_celsius), unit.name);
  return fmt::format("{} to {} {}", written(band.from_celsius), written(band.to_celsius),
                     unit.name);
}

Status CheckRange(const char* low_name, double low, const char* high_name, double high) {
  if (std::isfinite(low) && std::isfinite(high) && low < high) return OkStatus();
  return InvalidArgument(fmt::format("renderer.{} ({}) must be a number below renderer.{} ({})",
                                     low_name, low, high_name, high));
}

}  // namespace

Status Validate(const RendererExpertOptions& o) {
  ISOTHERM_RETURN_IF_ERROR(CheckRange("expert.percentile_low", o.percentile_low(),
                                      "expert.percentile_high", o.percentile_high()));
  if (o.percentile_low() < 0.0 || o.percentile_high() > 100.0) {
    return InvalidArgument(fmt::format(
        "renderer.expert: percentile_low ({}) and percentile_high ({}) must be 0..100 %",
        o.percentile_low(), o.percentile_high()));
  }
  // Wider lines would cover the rendering that they are to explain.
  constexpr double kMaxWidth_px = 50.0;
  if (!(o.isotherm_width_px() > 0.0 && o.isotherm_width_px() <= kMaxWidth_px)) {
    return InvalidArgument(
        fmt::format("renderer.expert.isotherm_width_px is {}, must be above 0 and at most {} px",
                    o.isotherm_width_px(), kMaxWidth_px));
  }
  // Wider smoothing moves lines visibly off the temperatures that they stand for. Not tuned.
  constexpr double kMaxSmoothing_px = 10.0;
  if (!(o.isotherm_smoothing_px() >= 0.0 && o.isotherm_smoothing_px() <= kMaxSmoothing_px)) {
    return InvalidArgument(
        fmt::format("renderer.expert.isotherm_smoothing_px is {}, must be 0..{} px",
                    o.isotherm_smoothing_px(), kMaxSmoothing_px));
  }
  return OkStatus();
}

Status Validate(const RendererOptions& options) {
  ISOTHERM_RETURN_IF_ERROR(CheckRange("scale_min_celsius", options.scale_min_celsius(),
                                      "scale_max_celsius", options.scale_max_celsius()));
  ISOTHERM_RETURN_IF_ERROR(Validate(options.expert()));
  if (const auto lines = IsothermsOf(options); !lines)
    return lines.error().WithContext("renderer.isotherm");
  if (const auto bands = BandsOf(options); !bands)
    return bands.error().WithContext("renderer.band");
  return OkStatus();
}

Renderer::Renderer(const RendererOptions& options, const ThermalOptions& thermal)
    : options_(options), thermal_(thermal), colours_(options) {
  auto lines = IsothermsOf(options);
  auto bands = BandsOf(options);
  // Validate() has refused lists that cannot be read.
  CHECK(lines && bands);
  lines_ = std::move(*lines);
  bands_ = std::move(*bands);
  if (options.palette() == GREY && options.expert().shading()) {
    LOG(Renderer, Warning)
        << "palette grey with shading: brightness stands for temperature and "
           "for the angle to the viewer; renderer.expert.shading=false removes the "
           "latter";
  }
}

std::optional<TemperatureScale> Renderer::ScaleFor(const ViewMaps& view) const {
  return ChooseScale(options_, view.celsius.pixels());
}

RgbImage Renderer::Draw(RenderLayer layer, const ViewMaps& view,
                        const std::optional<TemperatureScale>& scale,
                        const ContourField* contours) const {
  switch (layer) {
    case RenderLayer::kThermal:
      return Thermal(view, scale, contours);
    case RenderLayer::kDistance:
      return Distance(view);
    case RenderLayer::kAngle:
      return Angle(view);
    case RenderLayer::kMotion:
      return Motion(view);
    case RenderLayer::kDisagreement:
      return Disagreement(view);
    case RenderLayer::kAge:
      return NucAge(view);
    case RenderLayer::kUncertainty:
      return Uncertainty(view);
    case RenderLayer::kCoverage:
      return Coverage(view);
    case RenderLayer::kGeometry:
      break;
  }
  return Geometry(view);
}

Rgb8 Renderer::ColourOf(double celsius, const TemperatureScale& scale) const {
  const Rgb8 colour = colours_.At(scale.Fraction(celsius));
  bool highlights = false;
  for (const TemperatureBand& band : bands_) {
    if (band.Contains(celsius)) return band.colour.value_or(colour);
    // A band without a colour of its own is shown by taking the colour from everything else.
    highlights = highlights || !band.colour;
  }
  return highlights ? Greyed(colour) : colour;
}

ScaleLegend Renderer::ThermalLegend(const std::optional<TemperatureScale>& scale,
                                    bool with_lines) const {
  ScaleLegend legend;
  legend.scale = scale;
  legend.rule = "scale: " + ScaleRuleName(options_);
  legend.unit = DisplayUnitOf(options_.unit());
  if (options_.palette() == GREY && options_.expert().shading()) {
    legend.notes = {"grey: shading darkens", "too, do not read values"};
  }
  if (!scale) return legend;
  for (const TemperatureBand& band : bands_) {
    // The legend shows a band's own colour; an open band has no middle.
    const double middle = std::isinf(band.from_celsius) ? band.to_celsius
                          : std::isinf(band.to_celsius)
                              ? band.from_celsius
                              : (band.from_celsius + band.to_celsius) / 2.0;
    legend.rows.push_back({ColourOf(middle, *scale), BandName(band, legend.unit), "", ""});
  }
  if (!with_lines) return legend;
  for (const IsothermLine& line : lines_) {
    legend.marks.push_back({line.celsius, line.colour});
    legend.rows.push_back(
        {line.colour, fmt::format("line {:.4g} {}", legend.unit.Of(line.celsius), legend.unit.name),
         "", ""});
  }
  return legend;
}

RgbImage Renderer::Thermal(const ViewMaps& view, const std::optional<TemperatureScale>& scale,
                           const ContourField* contours) const {
  const bool shading = options_.expert().shading();
  RgbImage rendering = DrawSurface(view, [&](int x, int y) {
    const double cos_view = shading ? view.cos_view.At(x, y) : 1.0;
    const double celsius = view.celsius.At(x, y);
    if (std::isnan(celsius) || !scale) return NeverMeasuredColour(x, y, cos_view);
    return Shaded(ColourOf(celsius, *scale), cos_view);
  });
  if (contours != nullptr) {
    for (const IsothermLine& line : lines_) {
      const double width = options_.expert().isotherm_width_px();
      // The casing first, so that it does not cover the line.
      DrawLine(IsothermCover(*contours, line.celsius, width + 2.0 * kCasing_px), kCasingColour,
               kCasingOpacity, rendering);
      DrawLine(IsothermCover(*contours, line.celsius, width), line.colour, 1.0, rendering);
    }
  }
  if (!options_.expert().legend()) return rendering;
  ScaleLegend legend = ThermalLegend(scale, contours != nullptr);
  legend.title = view.celsius_meaning;
  return WithLegend(rendering, legend, [&](double celsius) { return ColourOf(celsius, *scale); });
}

RgbImage Renderer::Classes(const ViewMaps& view, const Image<std::uint8_t>& classes,
                           const ClassLegend& legend) const {
  const auto colour = [&](int x, int y) {
    const std::uint8_t condition = classes.At(x, y);
    // A temperature without a class was never checked for it.
    const bool unchecked = condition == kNeverMeasured && !std::isnan(view.celsius.At(x, y));
    return unchecked ? kUncheckedColour : ClassColour(condition);
  };
  const RgbImage rendering = DrawSurface(view, [&](int x, int y) {
    return Shaded(colour(x, y), options_.expert().shading() ? view.cos_view.At(x, y) : 1.0);
  });
  if (!options_.expert().legend()) return rendering;
  ClassLegend counted = legend;
  CountFractions(view, colour, counted);
  return WithLegend(rendering, counted);
}

RgbImage Renderer::Distance(const ViewMaps& view) const {
  const double min = thermal_.distance().min_m(), good = thermal_.distance().good_m(),
               max = thermal_.distance().max_m();
  return Classes(view, view.distance_class,
                 LegendOfClasses("measurement distance", fmt::format("{:.3g}-{:.3g} m", min, good),
                                 fmt::format("{:.3g}-{:.3g} m", good, max),
                                 fmt::format("< {:.3g} or > {:.3g} m", min, max)));
}

RgbImage Renderer::Angle(const ViewMaps& view) const {
  const double min = thermal_.angle().min_deg(), good = thermal_.angle().good_deg(),
               max = thermal_.angle().max_deg();
  const std::string too_frontal = min > 0.0 ? fmt::format("< {:g}\u00B0 or ", min) : "";
  return Classes(view, view.angle_class,
                 LegendOfClasses("emission angle", fmt::format("{:g}-{:g}\u00B0", min, good),
                                 fmt::format("{:g}-{:g}\u00B0", good, max),
                                 too_frontal + fmt::format("> {:g}\u00B0", max)));
}

RgbImage Renderer::Motion(const ViewMaps& view) const {
  ClassLegend legend = LegendOfClasses("camera motion", "sharp", "slightly smeared", "smeared");
  legend.rows.push_back({kUncheckedColour, "not checked", "", ""});
  return Classes(view, view.motion_class, legend);
}

RgbImage Renderer::Disagreement(const ViewMaps& view) const {
  ClassLegend legend = LegendOfClasses("disagreement", "measurements agree", "differ somewhat",
                                       "contradict: reflection?");
  legend.rows.push_back({kUncheckedColour, "not checked", "too few to compare", ""});
  return Classes(view, view.disagreement_class, legend);
}

RgbImage Renderer::Values(const ViewMaps& view, const Image<float>& values, double largest,
                          ScaleLegend legend) const {
  CHECK(values.size() == view.celsius.size());
  const auto colour = [largest](double value) { return InfernoColour(1.0 - value / largest); };
  const RgbImage rendering = DrawSurface(view, [&](int x, int y) {
    const double cos_view = options_.expert().shading() ? view.cos_view.At(x, y) : 1.0;
    const double value = values.At(x, y);
    if (!std::isnan(value)) return Shaded(colour(std::min(value, largest)), cos_view);
    return std::isnan(view.celsius.At(x, y)) ? NeverMeasuredColour(x, y, cos_view)
                                             : Shaded(kUncheckedColour, cos_view);
  });
  if (!options_.expert().legend()) return rendering;
  legend.rows = {{kUncheckedColour, "not known", "", ""}};
  return WithLegend(rendering, legend, colour);
}

RgbImage Renderer::NucAge(const ViewMaps& view) const {
  constexpr double kMinRange_s = 1.0;  // A shorter scale would only show the frames' periods.
  const TemperatureStatistics ages = Summarize(view.nuc_age_s.pixels());
  const double longest_s = std::max(ages.max_celsius, kMinRange_s);
  ScaleLegend legend;
  legend.title = "age since NUC";
  if (ages.count > 0) legend.scale = TemperatureScale{0.0, longest_s};
  legend.unit.name = "s";
  return Values(view, view.nuc_age_s, longest_s, legend);
}

RgbImage Renderer::Uncertainty(const ViewMaps& view) const {
  constexpr double kMinRange_k = 0.05;  // A shorter scale would only show the steps of the codes.
  constexpr double kShown = 0.95;       // The few worst ones would make all others look alike.
  std::vector<double> sigmas_k;
  for (const float sigma_k : view.sigma_k.pixels())
    if (!std::isnan(sigma_k)) sigmas_k.push_back(static_cast<double>(sigma_k));
  const double largest_k =
      sigmas_k.empty() ? kMinRange_k : std::max(TakeQuantile(sigmas_k, kShown), kMinRange_k);
  ScaleLegend legend;
  legend.title = "standard uncertainty";
  if (!sigmas_k.empty()) {
    legend.scale = TemperatureScale{0.0, largest_k};
    legend.scale->values_above =
        std::ranges::any_of(sigmas_k, [&](double sigma_k) { return sigma_k > largest_k; });
  }
  legend.unit.name = "K";
  return Values(view, view.sigma_k, largest_k, legend);
}

RgbImage Renderer::Coverage(const ViewMaps& view) const {
  ClassLegend legend{"coverage",
                     {{kMeasuredWellColour, "measured well", "", ""},
                      {kMeasuredAcceptablyColour, "acceptable", "", ""},
                      {kOnlyBadlyColour, "only badly", "measure again", ""},
                      {kMissingColour, "not measured", "only seen by depth", ""}}};
  const auto colour = [&](int x, int y) {
    return legend.rows[static_cast<std::size_t>(QualityAt(view, x, y))].colour;
  };
  const RgbImage rendering = DrawSurface(view, [&](int x, int y) {
    return Shaded(colour(x, y), options_.expert().shading() ? view.cos_view.At(x, y) : 1.0);
  });
  if (!options_.expert().legend()) return rendering;
  CountFractions(view, colour, legend);
  return WithLegend(rendering, legend);
}

RgbImage Renderer::Geometry(const ViewMaps& view) const {
  return DrawSurface(view,
                     [&](int x, int y) { return Shaded(kGeometryColour, view.cos_view.At(x, y)); });
}

}  // namespace isotherm
