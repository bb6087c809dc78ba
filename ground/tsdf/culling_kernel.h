#pragma once

#include <cstdint>

namespace isotherm {

inline constexpr int kFrustumPlanes = 5;

/// Writes the indices of those of `count` blocks whose coordinates (x y z each) satisfy
/// p[0] x + p[1] y + p[2] z + p[3] >= 0 for all planes p, in order, and returns how many there are.
/// `inside` must have room for `count` indices and a vector more.
std::int32_t CullBlocks(const float (&planes)[kFrustumPlanes][4], const std::int32_t* coordinates,
                        std::int32_t count, std::int32_t* inside);

/// Indices that `inside` must have room for beyond the number of blocks.
inline constexpr std::int32_t kCullingPadding = 64;

}  // namespace isotherm
