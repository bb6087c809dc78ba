#pragma once

#include <cstdint>

#include "common/frame/image.h"

namespace isotherm {

/// One sRGB colour, 8 bits per channel, in the order of PNG and PLY.
struct Rgb8 {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};
static_assert(sizeof(Rgb8) == 3);

using RgbImage = Image<Rgb8>;

}  // namespace isotherm
