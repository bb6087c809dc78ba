#pragma once

#include <string_view>

#include "ground/renderer/rgb.h"

namespace isotherm {

/// Says on which side of the text its position is.
enum class TextAlign { kLeft, kCentre, kRight };

/// Draws text and shapes into a rendering, anti-aliased. Coordinates are pixels, x right, y down;
/// everything is clipped to the rendering. Text is UTF-8, of which ASCII and the degree sign are
/// drawn. Thread-compatible.
class Canvas {
 public:
  /// `rendering` must outlive the canvas.
  explicit Canvas(RgbImage& rendering) : rendering_(rendering) {}

  void FillRectangle(int x, int y, int width, int height, Rgb8 colour);
  /// One pixel wide, inside the rectangle.
  void Frame(int x, int y, int width, int height, Rgb8 colour);
  struct Point {
    double x = 0.0, y = 0.0;
  };
  void FillTriangle(const Point& a, const Point& b, const Point& c, Rgb8 colour);
  /// `x` is the anchor chosen by `align`, `y_middle` the middle of a capital letter, `height_px`
  /// its height.
  void Text(double x, double y_middle, std::string_view text, double height_px, Rgb8 colour,
            TextAlign align = TextAlign::kLeft);

 private:
  RgbImage& rendering_;
};

/// Width of `text` as Canvas::Text draws it, pixels.
double TextWidth(std::string_view text, double height_px);

}  // namespace isotherm
