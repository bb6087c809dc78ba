#include "ground/renderer/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ground/renderer/canvas.h"
#include "ground/renderer/ticks.h"

namespace isotherm {
namespace {

constexpr Rgb8 kText{232, 234, 238};
constexpr Rgb8 kDimText{158, 164, 174};
constexpr Rgb8 kOutline{110, 116, 126};
// Sizes at a rendering height of 480 pixels; they grow with the rendering, but never below what can
// be read.
constexpr double kReferenceHeight = 480.0;
constexpr double kLetter_px = 9.0;
constexpr double kPanel_px = 156.0;
constexpr double kMinHeight = 240.0;
constexpr double kRow_px = 18.0;

/// A rendering with room for a panel, and the panel's measures in pixels.
struct Panel {
  /// At least `height_px` high at the reference height.
  explicit Panel(const RgbImage& rendering, double height_px = kMinHeight)
      : factor(std::clamp(rendering.height() / kReferenceHeight, 0.9, 4.0)),
        left(rendering.width()),
        image(rendering.width() + Px(kPanel_px), std::max(rendering.height(), Px(height_px)),
              kBackground) {
    const int top = (image.height() - rendering.height()) / 2;
    for (int y = 0; y < rendering.height(); ++y) {
      std::ranges::copy(rendering.Row(y), image.Row(top + y).begin());
    }
  }
  int Px(double reference_px) const { return static_cast<int>(std::lround(reference_px * factor)); }
  double letter() const { return kLetter_px * factor; }
  /// Letter height at which `text` from `x` on stays inside the panel, at most `wanted`.
  double Fitting(const std::string& text, double x, double wanted) const {
    const double room = image.width() - Px(8) - x;
    return wanted * std::min(1.0, room / std::max(TextWidth(text, wanted), 1.0));
  }

  const double factor;
  const int left;
  RgbImage image;
};

/// Draws the words of `title`, one per line; returns the y below them.
int DrawTitle(Panel& panel, Canvas& canvas, const std::string& title) {
  int y = panel.Px(20);
  std::istringstream words(title);
  for (std::string word; words >> word; y += panel.Px(18)) {
    canvas.Text(panel.left + panel.Px(16), y, word, panel.letter(), kText);
  }
  return y;
}

void DrawMarks(Panel& panel, Canvas& canvas, const ScaleLegend& legend, int top, int bottom) {
  const int x = panel.left + panel.Px(18);
  const int width = panel.Px(22);
  const int thick = std::max(panel.Px(1), 1);
  for (const ScaleMark& mark : legend.marks) {
    const double fraction = legend.scale->Fraction(mark.value);
    if (!(fraction >= 0.0 && fraction <= 1.0)) continue;
    const int y = static_cast<int>(std::lround(bottom - fraction * (bottom - top))) - thick / 2;
    canvas.FillRectangle(x, y - 1, width, thick + 2, kOutline);
    canvas.FillRectangle(x, y, width, thick, mark.colour);
  }
}

void DrawScaleBar(Panel& panel, Canvas& canvas, const ScaleLegend& legend,
                  const ValueColour& colour, int top, int bottom) {
  const TemperatureScale& scale = *legend.scale;
  const int x = panel.left + panel.Px(18);
  const int width = panel.Px(22);
  for (int y = top; y < bottom; ++y) {
    const double fraction = (bottom - 0.5 - y) / (bottom - top);
    canvas.FillRectangle(
        x, y, width, 1,
        colour(scale.min_celsius + fraction * (scale.max_celsius - scale.min_celsius)));
  }
  canvas.Frame(x - 1, top - 1, width + 2, bottom - top + 2, kOutline);
  const double tip = panel.Px(11);
  const double left = x, right = x + width - 1, middle = x + width / 2.0;
  if (scale.values_above) {
    const double y = top - 3;
    canvas.FillTriangle({left, y}, {right, y}, {middle, y - tip}, colour(scale.max_celsius));
  }
  if (scale.values_below) {
    const double y = bottom + 2;
    canvas.FillTriangle({left, y}, {right, y}, {middle, y + tip}, colour(scale.min_celsius));
  }
  DrawMarks(panel, canvas, legend, top, bottom);
  const int max_ticks = std::clamp((bottom - top) / panel.Px(26), 2, 12);
  const double low = legend.unit.Of(scale.min_celsius), high = legend.unit.Of(scale.max_celsius);
  for (const Tick& tick : RoundTicks(low, high, max_ticks)) {
    const double y = bottom - (tick.value - low) / (high - low) * (bottom - top);
    canvas.FillRectangle(x + width + 1, static_cast<int>(std::min(y, bottom - 1.0)), panel.Px(6), 1,
                         kText);
    canvas.Text(x + width + panel.Px(12), y, tick.label, panel.letter(), kText);
  }
}

void DrawNeverMeasuredKey(Panel& panel, Canvas& canvas, int y_middle) {
  const int x = panel.left + panel.Px(18);
  const int side = panel.Px(14);
  const int top = y_middle - side / 2;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      canvas.FillRectangle(x + u, top + v, 1, 1, NeverMeasuredColour(x + u, top + v, 1.0));
    }
  }
  canvas.Frame(x - 1, top - 1, side + 2, side + 2, kOutline);
  canvas.Text(x + panel.Px(22), y_middle, "not measured", panel.letter() * 0.95, kDimText);
}

}  // namespace

Rgb8 NeverMeasuredColour(int x, int y, double cos_view) {
  // Diagonal lines tell "never measured" from any grey of a colour map, also in print.
  constexpr int kLineDistance_px = 7;
  const bool line = (x + y) % kLineDistance_px == 0;
  const double brightness = std::clamp(0.35 + 0.65 * cos_view, 0.0, 1.0);
  const auto value = static_cast<std::uint8_t>(std::lround((line ? 132.0 : 92.0) * brightness));
  return {value, value, value};
}

RgbImage WithLegend(const RgbImage& rendering, const ScaleLegend& legend,
                    const ValueColour& colour) {
  const auto lines = static_cast<double>(legend.rows.size() + legend.notes.size());
  Panel panel(rendering, kMinHeight + kRow_px * lines);
  Canvas canvas(panel.image);
  const int left = panel.left + panel.Px(16);
  const int below_title = DrawTitle(panel, canvas, legend.title);
  canvas.Text(left, below_title, legend.scale ? "in " + legend.unit.name : "none measured",
              panel.letter(), kDimText);
  int bottom = panel.image.height() - panel.Px(22);
  for (auto note = legend.notes.rbegin(); note != legend.notes.rend(); ++note) {
    canvas.Text(left, bottom, *note, panel.Fitting(*note, left, panel.letter() * 0.9), kText);
    bottom -= panel.Px(kRow_px);
  }
  if (legend.never_measured) {
    DrawNeverMeasuredKey(panel, canvas, bottom);
    bottom -= panel.Px(24);
  }
  for (auto row = legend.rows.rbegin(); row != legend.rows.rend(); ++row) {
    const int side = panel.Px(12);
    const double text_x = left + panel.Px(24);
    canvas.FillRectangle(left + panel.Px(3), bottom - side / 2, side, side, row->colour);
    canvas.Frame(left + panel.Px(3), bottom - side / 2, side, side, kOutline);
    canvas.Text(text_x, bottom, row->name, panel.Fitting(row->name, text_x, panel.letter() * 0.95),
                kDimText);
    bottom -= panel.Px(kRow_px);
  }
  if (legend.scale) {
    canvas.Text(left, bottom, legend.rule, panel.letter() * 0.9, kDimText);
    DrawScaleBar(panel, canvas, legend, colour, below_title + panel.Px(32), bottom - panel.Px(28));
  }
  return std::move(panel.image);
}

RgbImage WithLegend(const RgbImage& rendering, const ClassLegend& legend) {
  Panel panel(rendering);
  Canvas canvas(panel.image);
  const int x = panel.left + panel.Px(18);
  const int side = panel.Px(14);
  int y = DrawTitle(panel, canvas, legend.title) + panel.Px(16);
  for (const LegendRow& row : legend.rows) {
    canvas.FillRectangle(x, y - side / 2, side, side, row.colour);
    canvas.Frame(x - 1, y - side / 2 - 1, side + 2, side + 2, kOutline);
    const double text_x = x + panel.Px(22);
    canvas.Text(text_x, y, row.name, panel.letter(), kText);
    for (const std::string& line : {row.detail, row.fraction}) {
      if (line.empty()) continue;
      y += panel.Px(17);
      canvas.Text(text_x, y, line, panel.Fitting(line, text_x, panel.letter() * 0.9), kDimText);
    }
    y += panel.Px(28);
  }
  return std::move(panel.image);
}

}  // namespace isotherm
