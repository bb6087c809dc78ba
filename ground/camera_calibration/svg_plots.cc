#include "ground/camera_calibration/svg_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/escape_html.h"

namespace isotherm {
namespace {

constexpr double kWidth = 420.0;  // Of a plot, in its own units.

/// From dark blue over green to yellow, 0..1.
std::string Colour(double part) {
  constexpr std::array<std::array<double, 3>, 4> kStops = {
      {{38, 30, 90}, {38, 110, 140}, {80, 190, 100}, {250, 230, 60}}};
  const double at = std::clamp(part, 0.0, 1.0) * (kStops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double fraction = at - static_cast<double>(low);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<int>(std::lerp(kStops[low][i], kStops[low + 1][i], fraction));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

std::string Open(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" width=\"{:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n",
      width, height, width);
}

/// Maps an interval of values to an interval of a plot.
struct Axis {
  double low = 0.0, high = 1.0;
  double begin = 0.0, end = 1.0;  ///< In the plot.

  double At(double value) const {
    return begin + (end - begin) * (value - low) / std::max(high - low, 1e-300);
  }
  /// Leaves a margin of a part of the interval on both sides.
  void Widen(double part) {
    const double margin = std::max(part * (high - low), 1e-6);
    low -= margin;
    high += margin;
  }
};

Axis Spanning(const std::vector<GraphSeries>& series, int dimension) {
  constexpr double kMargin = 0.05;
  Axis axis{.low = std::numeric_limits<double>::max(), .high = -std::numeric_limits<double>::max()};
  for (const GraphSeries& each : series) {
    for (std::size_t i = 0; i < each.points.size(); ++i) {
      const double reach = dimension == 1 && !each.sigmas.empty() ? 2.0 * each.sigmas[i] : 0.0;
      axis.low = std::min(axis.low, each.points[i](dimension) - reach);
      axis.high = std::max(axis.high, each.points[i](dimension) + reach);
    }
  }
  if (axis.low > axis.high) return {};
  axis.Widen(kMargin);
  return axis;
}

/// The largest of 1, 2 and 5 times a power of ten of which about five fit.
double TickStep(const Axis& axis) {
  constexpr double kTicks = 5.0;
  const double raw = (axis.high - axis.low) / kTicks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= raw) return factor * power;
  }
  return power;
}

std::string DrawAxes(const Axis& x, const Axis& y, std::string_view x_title,
                     std::string_view y_title) {
  std::string svg = fmt::format(
      "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#f8f8f8\" "
      "stroke=\"#888\"/>\n",
      x.begin, y.end, x.end - x.begin, y.begin - y.end);
  const auto ticks = [](const Axis& axis) {
    std::vector<double> values;
    const double step = TickStep(axis);
    const auto first = static_cast<long>(std::ceil(axis.low / step));
    const auto last = static_cast<long>(std::floor(axis.high / step));
    for (long i = first; i <= last; ++i) values.push_back(static_cast<double>(i) * step);
    return values;
  };
  for (const double value : ticks(x)) {
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.0f}V{2:.0f}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3:.0f}\" "
        "text-anchor=\"middle\">{4:g}</text>\n",
        x.At(value), y.begin, y.end, y.begin + 15.0, value);
  }
  for (const double value : ticks(y)) {
    svg += fmt::format(
        "<path d=\"M{1:.0f} {0:.1f}H{2:.0f}\" stroke=\"#ddd\"/><text x=\"{3:.0f}\" y=\"{0:.1f}\" "
        "dy=\"4\" text-anchor=\"end\">{4:g}</text>\n",
        y.At(value), x.begin, x.end, x.begin - 5.0, value);
  }
  return svg + fmt::format(
                   "<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text><text x=\"4\" "
                   "y=\"12\">{}</text>\n",
                   0.5 * (x.begin + x.end), y.begin + 32.0, EscapeHtml(x_title),
                   EscapeHtml(y_title));
}

std::string DrawSeries(const GraphSeries& series, const Axis& x, const Axis& y,
                       std::string_view colour) {
  std::string svg, path;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const Eigen::Vector2d& point = series.points[i];
    const double at_x = x.At(point.x()), at_y = y.At(point.y());
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", at_x, at_y);
    if (!series.sigmas.empty()) {
      svg += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" stroke=\"{}\" opacity=\"0.5\"/>\n",
                         at_x, y.At(point.y() - 2.0 * series.sigmas[i]),
                         y.At(point.y() + 2.0 * series.sigmas[i]), colour);
    }
    if (!series.is_line)
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", at_x,
                         at_y, colour);
  }
  if (series.is_line)
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\"/>\n", path, colour);
  return svg;
}

}  // namespace

std::string SvgMap(const ProjectionMap& map, std::string_view unit) {
  const double height = kWidth * map.size_px.y() / map.size_px.x();
  const double cell_x = kWidth / ProjectionMap::kColumns, cell_y = height / ProjectionMap::kRows;
  // Corners that no feature reached would leave no colours for the rest: a logarithmic scale.
  double low = 1e9;
  for (std::size_t i = 0; i < map.values_px.size(); ++i) {
    const double length = map.LengthAt(static_cast<int>(i));
    if (std::isfinite(length) && length > 0.0) low = std::min(low, length);
  }
  const double high = std::max(map.Max(false), 1.01 * low);
  std::string svg = Open(kWidth + 90.0, height);
  for (int i = 0; i < ProjectionMap::kColumns * ProjectionMap::kRows; ++i) {
    const double length = map.LengthAt(i);
    if (!std::isfinite(length)) continue;
    const int column = i % ProjectionMap::kColumns, row = i / ProjectionMap::kColumns;
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\">"
        "<title>{:.4f} {}</title></rect>\n",
        column * cell_x, row * cell_y, cell_x + 0.5, cell_y + 0.5,
        Colour(std::log(std::max(length, low) / low) / std::log(high / low)), length, unit);
  }
  constexpr int kSteps = 5;
  for (int i = 0; i <= kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    const double y = (height - 20.0) * (1.0 - part);
    svg += fmt::format(
        "<rect x=\"{:.0f}\" y=\"{:.1f}\" width=\"14\" height=\"14\" fill=\"{}\"/><text "
        "x=\"{:.0f}\" "
        "y=\"{:.1f}\">{:.3g} {}</text>\n",
        kWidth + 8.0, y, Colour(part), kWidth + 26.0, y + 12.0, low * std::pow(high / low, part),
        unit);
  }
  return svg + "</svg>\n";
}

std::string SvgFeatures(const std::vector<Eigen::Vector2d>& features_px,
                        const std::vector<Eigen::Vector2d>& residuals_px,
                        const Eigen::Vector2i& size_px, double magnified) {
  const double scale = kWidth / size_px.x(), height = scale * size_px.y();
  std::string svg = Open(kWidth, height);
  svg +=
      fmt::format("<rect width=\"{:.0f}\" height=\"{:.1f}\" fill=\"#f4f4f4\" stroke=\"#888\"/>\n",
                  kWidth, height);
  for (std::size_t i = 0; i < features_px.size(); ++i) {
    const Eigen::Vector2d from = scale * (features_px[i] + Eigen::Vector2d(0.5, 0.5));
    const Eigen::Vector2d to = from + scale * magnified * residuals_px[i];
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.2\" fill=\"#246\"/><path d=\"M{:.1f} "
        "{:.1f}L{:.1f} "
        "{:.1f}\" stroke=\"#c33\" stroke-width=\"0.8\"/>\n",
        from.x(), from.y(), from.x(), from.y(), to.x(), to.y());
  }
  return svg + "</svg>\n";
}

std::string SvgHistogram(const Eigen::VectorXd& values, double marked, std::string_view title) {
  constexpr int kBins = 30;
  constexpr double kPlot = 200.0, kHeight = 110.0;
  std::string svg = Open(kPlot, kHeight + 34.0);
  const double low = values.minCoeff(), high = values.maxCoeff();
  const double step = std::max((high - low) / kBins, 1e-300);
  std::array<int, kBins> counts{};
  for (const double value : values)
    ++counts[static_cast<std::size_t>(
        std::clamp(static_cast<int>((value - low) / step), 0, kBins - 1))];
  const int most = *std::max_element(counts.begin(), counts.end());
  for (int i = 0; i < kBins; ++i) {
    const double bar = kHeight * counts[static_cast<std::size_t>(i)] / std::max(1, most);
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#47a\"/>\n",
        i * kPlot / kBins, kHeight - bar, kPlot / kBins - 0.5, bar);
  }
  const double x = kPlot * (marked - low) / std::max(high - low, 1e-300);
  svg += fmt::format(
      "<path d=\"M{0:.1f} 0V{1:.0f}\" stroke=\"#c33\"/>\n<text x=\"0\" y=\"{2:.0f}\">{3:.5g}</text>"
      "<text x=\"{4:.0f}\" y=\"{2:.0f}\" text-anchor=\"end\">{5:.5g}</text><text x=\"{6:.0f}\" "
      "y=\"{7:.0f}\" text-anchor=\"middle\">{8}</text>\n",
      x, kHeight, kHeight + 13.0, low, kPlot, high, 0.5 * kPlot, kHeight + 29.0, EscapeHtml(title));
  return svg + "</svg>\n";
}

std::string SvgGraph(const std::vector<GraphSeries>& series, std::string_view x_title,
                     std::string_view y_title) {
  constexpr double kHeight = 260.0, kLeft = 48.0, kTop = 22.0, kBottom = 40.0, kLegend = 18.0;
  constexpr std::array<const char*, 4> kColours = {"#c33", "#246", "#2a2", "#a70"};
  Axis x = Spanning(series, 0), y = Spanning(series, 1);
  x.begin = kLeft;
  x.end = kWidth - 6.0;
  y.begin = kHeight - kBottom;
  y.end = kTop;
  std::string svg = Open(kWidth, kHeight + kLegend * static_cast<double>(series.size()));
  svg += DrawAxes(x, y, x_title, y_title);
  for (std::size_t i = 0; i < series.size(); ++i) {
    const char* colour = kColours.at(i % kColours.size());
    svg += DrawSeries(series[i], x, y, colour);
    svg += fmt::format(
        "<circle cx=\"{0:.0f}\" cy=\"{1:.0f}\" r=\"4\" fill=\"{2}\"/><text x=\"{3:.0f}\" "
        "y=\"{1:.0f}\" dy=\"4\">{4}</text>\n",
        kLeft, kHeight + kLegend * (static_cast<double>(i) + 0.5), colour, kLeft + 10.0,
        EscapeHtml(series[i].name));
  }
  return svg + "</svg>\n";
}

}  // namespace isotherm
