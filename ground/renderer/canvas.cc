#include "ground/renderer/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace isotherm {
namespace {

// Shapes are drawn into a mask this many times larger and averaged down: OpenCV's stroke fonts look
// coarse at their own anti-aliasing.
constexpr int kSupersampling = 4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
// Height of a capital letter of the Hershey simplex font at scale 1, pixels.
constexpr double kCapitalHeight = 21.0;
constexpr double kStrokePerHeight = 0.125;
constexpr std::string_view kDegree = "\u00B0";
// Size of the drawn degree sign, in capital heights.
constexpr double kDegreeRadius = 0.16;
constexpr double kDegreeAdvance = 0.55;

struct Stroke {
  double scale;
  int thickness;
};

Stroke StrokeFor(double height_px) {
  const double height = height_px * kSupersampling;
  return {height / kCapitalHeight,
          std::max(1, static_cast<int>(std::lround(height * kStrokePerHeight)))};
}

/// Advances `x` (supersampled pixels) over `text`; draws into `mask` unless it is empty.
void Write(std::string_view text, double height_px, double baseline, double& x, cv::Mat& mask) {
  const Stroke stroke = StrokeFor(height_px);
  const double capital = height_px * kSupersampling;
  const cv::Scalar white(255);
  while (!text.empty()) {
    if (text.starts_with(kDegree)) {
      const cv::Point centre(static_cast<int>(x + capital * 0.25),
                             static_cast<int>(baseline - capital * (1.0 - kDegreeRadius)));
      if (!mask.empty()) {
        cv::circle(mask, centre, static_cast<int>(capital * kDegreeRadius), white, stroke.thickness,
                   cv::LINE_AA);
      }
      x += capital * kDegreeAdvance;
      text.remove_prefix(kDegree.size());
      continue;
    }
    const std::string part(text.substr(0, text.find(kDegree)));
    int below = 0;
    const cv::Size size = cv::getTextSize(part, kFont, stroke.scale, stroke.thickness, &below);
    if (!mask.empty()) {
      cv::putText(mask, part, cv::Point(static_cast<int>(x), static_cast<int>(baseline)), kFont,
                  stroke.scale, white, stroke.thickness, cv::LINE_AA);
    }
    x += size.width;
    text.remove_prefix(part.size());
  }
}

/// Mixes `colour` into the picture where the supersampled `mask`, whose corner is at (x, y), is
/// set.
void Blend(const cv::Mat& mask, int x, int y, Rgb8 colour, RgbImage& picture) {
  cv::Mat small;
  cv::resize(mask, small, cv::Size(mask.cols / kSupersampling, mask.rows / kSupersampling), 0, 0,
             cv::INTER_AREA);
  for (int v = 0; v < small.rows; ++v) {
    for (int u = 0; u < small.cols; ++u) {
      if (!picture.Contains(x + u, y + v)) continue;
      Rgb8& pixel = picture.At(x + u, y + v);
      const int cover = small.at<std::uint8_t>(v, u);
      const auto mix = [cover](std::uint8_t from, std::uint8_t to) {
        return static_cast<std::uint8_t>((from * (255 - cover) + to * cover + 127) / 255);
      };
      pixel = {mix(pixel.r, colour.r), mix(pixel.g, colour.g), mix(pixel.b, colour.b)};
    }
  }
}

}  // namespace

void Canvas::FillRectangle(int x, int y, int width, int height, Rgb8 colour) {
  for (int v = std::max(y, 0); v < std::min(y + height, picture_.height()); ++v) {
    for (int u = std::max(x, 0); u < std::min(x + width, picture_.width()); ++u) {
      picture_.At(u, v) = colour;
    }
  }
}

void Canvas::Frame(int x, int y, int width, int height, Rgb8 colour) {
  FillRectangle(x, y, width, 1, colour);
  FillRectangle(x, y + height - 1, width, 1, colour);
  FillRectangle(x, y, 1, height, colour);
  FillRectangle(x + width - 1, y, 1, height, colour);
}

void Canvas::FillTriangle(double x0, double y0, double x1, double y1, double x2, double y2,
                          Rgb8 colour) {
  const int left = static_cast<int>(std::floor(std::min({x0, x1, x2})));
  const int top = static_cast<int>(std::floor(std::min({y0, y1, y2})));
  const int width = static_cast<int>(std::ceil(std::max({x0, x1, x2}))) - left + 1;
  const int height = static_cast<int>(std::ceil(std::max({y0, y1, y2}))) - top + 1;
  cv::Mat mask = cv::Mat::zeros(height * kSupersampling, width * kSupersampling, CV_8U);
  const auto point = [&](double x, double y) {
    return cv::Point(static_cast<int>(std::lround((x - left) * kSupersampling)),
                     static_cast<int>(std::lround((y - top) * kSupersampling)));
  };
  const std::array<cv::Point, 3> corners = {point(x0, y0), point(x1, y1), point(x2, y2)};
  cv::fillConvexPoly(mask, corners.data(), 3, cv::Scalar(255), cv::LINE_AA);
  Blend(mask, left, top, colour, picture_);
}

void Canvas::Text(double x, double y_middle, std::string_view text, double height_px, Rgb8 colour,
                  TextAlign align) {
  const double width = TextWidth(text, height_px);
  const double left = align == TextAlign::kLeft    ? x
                      : align == TextAlign::kRight ? x - width
                                                   : x - width / 2.0;
  const int margin = static_cast<int>(std::ceil(height_px));  // Room for descenders and strokes.
  const int corner_x = static_cast<int>(std::floor(left)) - margin;
  const int corner_y = static_cast<int>(std::floor(y_middle - height_px / 2.0)) - margin;
  const int mask_width = static_cast<int>(std::ceil(width)) + 2 * margin;
  cv::Mat mask = cv::Mat::zeros(kSupersampling * 3 * margin, kSupersampling * mask_width, CV_8U);
  double pen = (left - corner_x) * kSupersampling;
  Write(text, height_px, (y_middle + height_px / 2.0 - corner_y) * kSupersampling, pen, mask);
  Blend(mask, corner_x, corner_y, colour, picture_);
}

double TextWidth(std::string_view text, double height_px) {
  double x = 0.0;
  cv::Mat no_mask;
  Write(text, height_px, 0.0, x, no_mask);
  return x / kSupersampling;
}

}  // namespace isotherm
