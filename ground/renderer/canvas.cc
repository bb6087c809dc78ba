#include "ground/renderer/canvas.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ground/renderer/stroke_font.h"

namespace isotherm {
namespace {

/// Width of a letter's stroke, in heights of a capital letter.
constexpr double kStrokePerHeight = 0.125;

/// Returns how much of a pixel a shape covers whose edge is this many pixels from the pixel's
/// centre, negative inside. Exact for an edge along a row or a column.
double Cover(double distance_px) { return std::clamp(0.5 - distance_px, 0.0, 1.0); }

/// Mixes as much of `colour` into the pixel, if there is one.
void Blend(int x, int y, Rgb8 colour, double cover, RgbImage& rendering) {
  if (!(cover > 0.0) || !rendering.Contains(x, y)) return;
  const auto mix = [cover](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + cover * (to - from)));
  };
  Rgb8& pixel = rendering.At(x, y);
  pixel = {mix(pixel.r, colour.r), mix(pixel.g, colour.g), mix(pixel.b, colour.b)};
}

double Distance(double x, double y, const StrokeLine& line) {
  const double dx = line.x1 - line.x0, dy = line.y1 - line.y0;
  const double square = dx * dx + dy * dy;
  const double along = square > 0.0 ? ((x - line.x0) * dx + (y - line.y0) * dy) / square : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(x - line.x0 - t * dx, y - line.y0 - t * dy);
}

int Floor(double value) { return static_cast<int>(std::floor(value)); }
int Ceil(double value) { return static_cast<int>(std::ceil(value)); }

/// Raises the cover of the pixels around `line` to that of a stroke with round ends: where strokes
/// meet, the one counts that covers a pixel most.
void Stroke(const StrokeLine& line, double half_width_px, Image<float>& mask) {
  const double reach = half_width_px + 1.0;
  const int left = std::max(Floor(std::min(line.x0, line.x1) - reach), 0);
  const int top = std::max(Floor(std::min(line.y0, line.y1) - reach), 0);
  const int right = std::min(Ceil(std::max(line.x0, line.x1) + reach), mask.width());
  const int bottom = std::min(Ceil(std::max(line.y0, line.y1) + reach), mask.height());
  for (int v = top; v < bottom; ++v) {
    for (int u = left; u < right; ++u) {
      const double cover = Cover(Distance(u + 0.5, v + 0.5, line) - half_width_px);
      mask.At(u, v) = std::max(mask.At(u, v), static_cast<float>(cover));
    }
  }
}

}  // namespace

void Canvas::FillRectangle(int x, int y, int width, int height, Rgb8 colour) {
  for (int v = std::max(y, 0); v < std::min(y + height, rendering_.height()); ++v) {
    for (int u = std::max(x, 0); u < std::min(x + width, rendering_.width()); ++u) {
      rendering_.At(u, v) = colour;
    }
  }
}

void Canvas::Frame(int x, int y, int width, int height, Rgb8 colour) {
  FillRectangle(x, y, width, 1, colour);
  FillRectangle(x, y + height - 1, width, 1, colour);
  FillRectangle(x, y, 1, height, colour);
  FillRectangle(x + width - 1, y, 1, height, colour);
}

void Canvas::FillTriangle(const Point& a, const Point& b, const Point& c, Rgb8 colour) {
  const StrokeLine sides[] = {{a.x, a.y, b.x, b.y}, {b.x, b.y, c.x, c.y}, {c.x, c.y, a.x, a.y}};
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  const double winding = area > 0.0 ? 1.0 : -1.0;
  const int left = std::max(Floor(std::min({a.x, b.x, c.x})) - 1, 0);
  const int top = std::max(Floor(std::min({a.y, b.y, c.y})) - 1, 0);
  const int right = std::min(Ceil(std::max({a.x, b.x, c.x})) + 1, rendering_.width());
  const int bottom = std::min(Ceil(std::max({a.y, b.y, c.y})) + 1, rendering_.height());
  for (int v = top; v < bottom; ++v) {
    for (int u = left; u < right; ++u) {
      double cover = 1.0;
      for (const StrokeLine& side : sides) {
        const double dx = side.x1 - side.x0, dy = side.y1 - side.y0;
        const double cross = dy * (u + 0.5 - side.x0) - dx * (v + 0.5 - side.y0);
        cover = std::min(cover, Cover(winding * cross / std::hypot(dx, dy)));
      }
      Blend(u, v, colour, cover, rendering_);
    }
  }
}

void Canvas::Text(double x, double y_middle, std::string_view text, double height_px, Rgb8 colour,
                  TextAlign align) {
  const double width = TextWidth(text, height_px);
  const double left = align == TextAlign::kLeft    ? x
                      : align == TextAlign::kRight ? x - width
                                                   : x - width / 2.0;
  const int margin = Ceil(height_px);  // Room for descenders and strokes.
  const int corner_x = Floor(left) - margin;
  const int corner_y = Floor(y_middle - height_px / 2.0) - margin;
  const double baseline = y_middle + height_px / 2.0;
  Image<float> mask(Ceil(width) + 2 * margin, 3 * margin);
  for (const StrokeLine& line : TextStrokes(text)) {
    const auto u = [&](double unit) { return left + height_px * unit - corner_x; };
    const auto v = [&](double unit) { return baseline + height_px * unit - corner_y; };
    Stroke({u(line.x0), v(line.y0), u(line.x1), v(line.y1)}, 0.5 * kStrokePerHeight * height_px,
           mask);
  }
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u)
      Blend(corner_x + u, corner_y + v, colour, mask.At(u, v), rendering_);
  }
}

double TextWidth(std::string_view text, double height_px) { return height_px * TextAdvance(text); }

}  // namespace isotherm
