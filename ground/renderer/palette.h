#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ground/options/ground_options.pb.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

/// Moreland's diverging map from (59, 76, 192) over near-white to (180, 4, 38), known as
/// "coolwarm". `fraction` in [0, 1]. Computed from the definition in Msh space: K. Moreland,
/// "Diverging color maps for scientific visualization", ISVC 2009, algorithms in section 5.
Rgb8 CoolwarmColour(double fraction);

/// Black to white, linear in the sRGB value.
Rgb8 GreyColour(double fraction);

/// Black, blue, violet, orange, yellow, white. The formulae 30, 31 and 32 for red, green and blue
/// of gnuplot's manual ("set palette rgbformulae", "color printable on gray"): brightness rises all
/// the way.
Rgb8 IronColour(double fraction);

/// Blue, green, yellow, red: the formulae 33, 13 and 10 of the same list ("rainbow").
Rgb8 RainbowColour(double fraction);

/// S. van der Walt and N. Smith's "inferno" (matplotlib 2.0, BIDS/colormap, public domain by CC0):
/// 23 of its 256 entries, linear in between; 3/255 off at most.
Rgb8 InfernoColour(double fraction);

Rgb8 PaletteColour(Palette palette, double fraction);

/// As in options and headers, lower case: "coolwarm".
std::string PaletteName(Palette palette);
/// Any case; nullopt if there is none of this name.
std::optional<Palette> PaletteFromName(std::string_view name);

/// A palette as a table, for one look-up per pixel. Thread-compatible.
class ColourTable {
 public:
  explicit ColourTable(const RendererOptions& options);

  /// Colour at `fraction` of the palette; outside [0, 1] the end colours.
  Rgb8 At(double fraction) const;

 private:
  std::vector<Rgb8> colours_;
};

}  // namespace isotherm
