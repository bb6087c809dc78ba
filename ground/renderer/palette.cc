#include "ground/renderer/palette.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <numbers>

namespace isotherm {
namespace {

/// Polar form of CIELAB: magnitude, saturation angle, hue angle (Moreland 2009, section 4.2).
struct Msh {
  double m, s, h;
};

// CIE 1931 white point D65, Y = 1, which sRGB refers to.
const Eigen::Vector3d kWhiteXyz(0.9505, 1.0, 1.0890);
// Least magnitude of the point in the middle: near white, but not white.
constexpr double kMiddleMagnitude = 88.0;

/// Linear sRGB -> XYZ (IEC 61966-2-1).
Eigen::Matrix3d XyzFromLinear() {
  return (Eigen::Matrix3d() << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192,
          0.9505)
      .finished();
}

double Linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double Srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double LabForward(double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; }

double LabInverse(double f) { return f > 0.20689 ? f * f * f : (f - 16.0 / 116.0) / 7.787; }

/// sRGB -> XYZ -> CIELAB -> Msh.
Msh MshFromRgb(const Rgb8& rgb) {
  const Eigen::Vector3d linear(Linear(rgb.r / 255.0), Linear(rgb.g / 255.0), Linear(rgb.b / 255.0));
  const Eigen::Vector3d xyz = XyzFromLinear() * linear;
  const Eigen::Vector3d f = xyz.cwiseQuotient(kWhiteXyz).unaryExpr(&LabForward);
  const Eigen::Vector3d lab(116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z()));
  const double m = lab.norm();
  return {m, std::acos(lab.x() / m), std::atan2(lab.z(), lab.y())};
}

/// A fraction of full intensity as 8 bits, cut off outside [0, 1].
std::uint8_t Channel(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

/// The way back; colours outside sRGB are cut off per channel.
Rgb8 RgbFromMsh(const Msh& msh) {
  const double lightness = msh.m * std::cos(msh.s);
  const double a = msh.m * std::sin(msh.s) * std::cos(msh.h);
  const double b = msh.m * std::sin(msh.s) * std::sin(msh.h);
  const double fy = (lightness + 16.0) / 116.0;
  const Eigen::Vector3d f(fy + a / 500.0, fy, fy - b / 200.0);
  const Eigen::Vector3d xyz = f.unaryExpr(&LabInverse).cwiseProduct(kWhiteXyz);
  const Eigen::Vector3d linear = XyzFromLinear().inverse() * xyz;
  return {Channel(Srgb(linear.x())), Channel(Srgb(linear.y())), Channel(Srgb(linear.z()))};
}

/// The hue an unsaturated colour gets, so that the path to `saturated` bends least (Moreland 2009,
/// AdjustHue).
double AdjustedHue(const Msh& saturated, double unsaturated_m) {
  if (saturated.m >= unsaturated_m) return saturated.h;
  const double spin = saturated.s *
                      std::sqrt(unsaturated_m * unsaturated_m - saturated.m * saturated.m) /
                      (saturated.m * std::sin(saturated.s));
  return saturated.h > -std::numbers::pi / 3.0 ? saturated.h + spin : saturated.h - spin;
}

struct InfernoEntry {
  int entry;  ///< 0..255
  Rgb8 colour;
};

// Denser where the colour turns.
constexpr InfernoEntry kInferno[] = {
    {0, {0, 0, 4}},         {15, {10, 7, 34}},      {30, {30, 12, 69}},     {45, {56, 9, 98}},
    {60, {81, 14, 108}},    {75, {105, 22, 110}},   {90, {128, 31, 108}},   {105, {152, 39, 102}},
    {120, {176, 49, 91}},   {135, {198, 61, 77}},   {150, {217, 77, 61}},   {165, {233, 97, 43}},
    {180, {244, 121, 24}},  {187, {248, 133, 15}},  {195, {250, 148, 7}},   {202, {252, 161, 8}},
    {210, {252, 176, 20}},  {217, {251, 190, 35}},  {225, {248, 205, 55}},  {232, {245, 219, 76}},
    {240, {242, 234, 105}}, {247, {243, 245, 134}}, {255, {252, 255, 164}},
};

}  // namespace

Rgb8 CoolwarmColour(double fraction) {
  // The two ends are further apart in hue than pi/3, so the path leads through a near-white middle.
  const Msh cool = MshFromRgb({59, 76, 192});
  const Msh warm = MshFromRgb({180, 4, 38});
  const double middle_m = std::max({cool.m, warm.m, kMiddleMagnitude});
  const bool lower = fraction < 0.5;
  const Msh& end = lower ? cool : warm;
  const Msh middle{middle_m, 0.0, AdjustedHue(end, middle_m)};
  const double from_end = lower ? 2.0 * fraction : 2.0 - 2.0 * fraction;
  const auto mix = [from_end](double a, double b) { return a + from_end * (b - a); };
  return RgbFromMsh({mix(end.m, middle.m), mix(end.s, middle.s), mix(end.h, middle.h)});
}

Rgb8 GreyColour(double fraction) {
  return {Channel(fraction), Channel(fraction), Channel(fraction)};
}

Rgb8 IronColour(double fraction) {
  const double x = std::clamp(fraction, 0.0, 1.0);
  const double blue = x < 0.25   ? 4.0 * x
                      : x < 0.42 ? 1.0
                      : x < 0.92 ? 1.84 - 2.0 * x
                                 : x / 0.08 - 11.5;
  return {Channel(x / 0.32 - 0.78125), Channel(2.0 * x - 0.84), Channel(blue)};
}

Rgb8 RainbowColour(double fraction) {
  const double x = std::clamp(fraction, 0.0, 1.0);
  return {Channel(std::abs(2.0 * x - 0.5)), Channel(std::sin(std::numbers::pi * x)),
          Channel(std::cos(std::numbers::pi / 2.0 * x))};
}

Rgb8 InfernoColour(double fraction) {
  const double entry = 255.0 * std::clamp(fraction, 0.0, 1.0);
  const auto* next = std::ranges::lower_bound(kInferno, entry, {}, &InfernoEntry::entry);
  if (next == std::begin(kInferno)) return next->colour;
  const InfernoEntry& before = *(next - 1);
  const double part = (entry - before.entry) / (next->entry - before.entry);
  const auto mix = [part](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + part * (b - a)));
  };
  return {mix(before.colour.r, next->colour.r), mix(before.colour.g, next->colour.g),
          mix(before.colour.b, next->colour.b)};
}

Rgb8 PaletteColour(Palette palette, double fraction) {
  switch (palette) {
    case COOLWARM:
      return CoolwarmColour(fraction);
    case GREY:
      return GreyColour(fraction);
    case IRON:
      return IronColour(fraction);
    case RAINBOW:
      return RainbowColour(fraction);
    case INFERNO:
      return InfernoColour(fraction);
  }
  return GreyColour(fraction);
}

std::string PaletteName(Palette palette) {
  std::string name = Palette_Name(palette);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

std::optional<Palette> PaletteFromName(std::string_view name) {
  std::string upper(name);
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  Palette palette;
  return Palette_Parse(upper, &palette) ? std::optional(palette) : std::nullopt;
}

ColourTable::ColourTable(const RendererOptions& options) {
  constexpr int kEntries = 1025;  // Odd, so that the middle of the palette is an entry.
  colours_.reserve(kEntries);
  for (int i = 0; i < kEntries; ++i) {
    colours_.push_back(PaletteColour(options.palette(), static_cast<double>(i) / (kEntries - 1)));
  }
}

Rgb8 ColourTable::At(double fraction) const {
  const double last = static_cast<double>(colours_.size() - 1);
  // The negated comparison also sends NaN to the first entry instead of out of the table.
  if (!(fraction > 0.0)) return colours_.front();
  return colours_[static_cast<std::size_t>(std::min(fraction, 1.0) * last + 0.5)];
}

}  // namespace isotherm
