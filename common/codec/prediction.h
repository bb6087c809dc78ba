#pragma once

#include <cstdlib>

#include "common/codec/residual_token.h"

/// A pixel is predicted from its west, north, north-west and north-east neighbours, which also tell
/// the one of a few contexts it is in. Each context has its own token frequencies: they tell flat
/// areas, where the difference is the camera's noise, from edges.
namespace isotherm::codec {

/// Values that have been coded before; a hole has the value above it.
struct Neighbours {
  int west = 0;
  int north = 0;
  int north_west = 0;
  int north_east = 0;
};

/// By value, unlike std::min: compilers make vector instructions of it.
constexpr int Min(int a, int b) { return a < b ? a : b; }
constexpr int Max(int a, int b) { return a > b ? a : b; }

/// Returns how much the neighbours differ.
constexpr int Activity(const Neighbours& pixels) {
  return std::abs(pixels.west - pixels.north_west) + std::abs(pixels.north - pixels.north_west) +
         std::abs(pixels.north - pixels.north_east);
}

/// Depth. Value 0 is a hole (no return) and has a token of its own; the context also says which of
/// the western and northern neighbours are holes.
struct DepthModel {
  static constexpr bool kHasHoles = true;
  /// How different the neighbours are chooses one of these statistics. More: each is learnt from
  /// fewer pixels and its table costs bytes; fewer: edges spoil the statistics of smooth surface.
  /// Fixed by the format.
  static constexpr int kActivityLevels = 6;
  /// Most differences are so small that their token says it all.
  static constexpr bool kRawBitsAreRare = true;

  static constexpr int Predict(const Neighbours& pixels) {
    return (pixels.west + pixels.north) >> 1;
  }
};

/// Temperature, by the median edge detector (Weinberger, Seroussi, Sapiro, "LOCO-I", 2000): the
/// plane through the neighbours or, at an edge, the neighbour on the pixel's side.
struct ThermalModel {
  static constexpr bool kHasHoles = false;
  /// As above. Fixed by the format.
  static constexpr int kActivityLevels = 12;
  static constexpr bool kRawBitsAreRare = false;

  static constexpr int Predict(const Neighbours& pixels) {
    const int least = Min(pixels.west, pixels.north);
    const int most = Max(pixels.west, pixels.north);
    return least + most - Min(Max(pixels.north_west, least), most);
  }
};

template <typename Model>
inline constexpr int kContexts = Model::kActivityLevels*(Model::kHasHoles ? 4 : 1);
template <typename Model>
inline constexpr int kTokens = kResidualTokens + (Model::kHasHoles ? 1 : 0);

/// `activity_bits` is the number of bits of the activity.
template <typename Model>
constexpr int Context(int activity_bits, bool hole_west, bool hole_north) {
  const int activity = Min(activity_bits, Model::kActivityLevels - 1);
  if constexpr (!Model::kHasHoles) return activity;
  return activity + (hole_west ? Model::kActivityLevels : 0) +
         (hole_north ? 2 * Model::kActivityLevels : 0);
}

}  // namespace isotherm::codec
