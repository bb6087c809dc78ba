#pragma once

namespace isotherm {

/// A camera's process finds its end of the link and the shared memory under these descriptors.
inline constexpr int kCameraLinkDescriptor = 3;
inline constexpr int kCameraPixelsDescriptor = 4;

}  // namespace isotherm
