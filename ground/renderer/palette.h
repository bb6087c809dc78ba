#pragma once

#include <vector>

#include "ground/renderer/rgb.h"

namespace isotherm {

class RendererOptions;

/// Moreland's diverging map from (59, 76, 192) over near-white to (180, 4, 38), known as
/// "coolwarm". `share` in [0, 1]. Computed from the definition in Msh space: K. Moreland,
/// "Diverging color maps for scientific visualization", ISVC 2009, algorithms in section 5.
Rgb8 CoolwarmColour(double share);

/// Black to white, linear in the sRGB value.
Rgb8 GreyColour(double share);

/// A palette as a table, for one look-up per pixel. Thread-compatible.
class ColourTable {
 public:
  explicit ColourTable(const RendererOptions& options);

  /// Colour at `share` of the palette; outside [0, 1] the end colours.
  Rgb8 At(double share) const;

 private:
  std::vector<Rgb8> colours_;
};

}  // namespace isotherm
