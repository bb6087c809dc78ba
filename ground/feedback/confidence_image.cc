#include "ground/feedback/confidence_image.h"

#include <algorithm>
#include <cmath>

#include "ground/renderer/canvas.h"
#include "ground/renderer/png.h"

namespace isotherm {
namespace {

constexpr Rgb8 kNothing{24, 24, 24};
constexpr Rgb8 kGood{60, 190, 80};
constexpr Rgb8 kAcceptable{240, 210, 60};
constexpr Rgb8 kBad{220, 60, 50};
constexpr Rgb8 kNever{90, 120, 230};
constexpr Rgb8 kAlarm{255, 0, 0};
constexpr int kAlarmFrame_px = 3;

// Few shades, so that the image packs well.
constexpr int kShades = 4;
// Slanted surface must not be mistaken for the background.
constexpr double kDarkest = 0.4;

// A smaller image is all frame when it shows the alarm.
constexpr int kMinSide_px = 4;

Rgb8 ColourOf(MeasurementQuality quality) {
  switch (quality) {
    case MeasurementQuality::kGood:
      return kGood;
    case MeasurementQuality::kAcceptable:
      return kAcceptable;
    case MeasurementQuality::kBad:
      return kBad;
    case MeasurementQuality::kNever:
      break;
  }
  return kNever;
}

Rgb8 Shaded(Rgb8 colour, double cosine) {
  const double step = std::round(cosine * (kShades - 1)) / (kShades - 1);
  const double brightness = kDarkest + (1.0 - kDarkest) * step;
  const auto shade = [&](std::uint8_t channel) {
    return static_cast<std::uint8_t>(std::lround(channel * brightness));
  };
  return {shade(colour.r), shade(colour.g), shade(colour.b)};
}

RgbImage Halved(const RgbImage& image) {
  RgbImage half(image.width() / 2, image.height() / 2);
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) half.At(x, y) = image.At(2 * x, 2 * y);
  }
  return half;
}

}  // namespace

RgbImage DrawConfidence(const ViewMaps& view, bool lost) {
  RgbImage image(view.width(), view.height(), kNothing);
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      if (!view.HasSurface(x, y)) continue;
      const MeasurementQuality quality = QualityAt(view, x, y);
      image.At(x, y) = Shaded(ColourOf(quality), view.cos_view.At(x, y));
    }
  }
  if (!lost) return image;
  Canvas canvas(image);
  for (int i = 0; i < kAlarmFrame_px; ++i) {
    canvas.Frame(i, i, view.width() - 2 * i, view.height() - 2 * i, kAlarm);
  }
  return image;
}

std::vector<std::uint8_t> EncodeWithin(RgbImage image, std::size_t max_bytes) {
  while (image.width() >= kMinSide_px && image.height() >= kMinSide_px) {
    Result<std::vector<std::uint8_t>> bytes = EncodePng(image);
    if (!bytes) return {};
    if (bytes->size() <= max_bytes) return std::move(*bytes);
    image = Halved(image);
  }
  return {};
}

}  // namespace isotherm
