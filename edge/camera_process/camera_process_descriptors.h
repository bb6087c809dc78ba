#pragma once

namespace isotherm {

/// Where a camera's process finds its end of the link and the shared memory.
inline constexpr int kCameraLinkDescriptor = 3;
inline constexpr int kCameraPixelsDescriptor = 4;

}  // namespace isotherm
