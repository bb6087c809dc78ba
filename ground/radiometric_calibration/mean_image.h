#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "common/rig/rig.h"

namespace isotherm {

/// The mean of the thermal images of a camera that rests.
struct MeanImage {
  Image<float> celsius;  ///< As the camera reads; NaN: a pixel was without a value once.
  int frames = 0;
};

/// Reads a recording (valid frames), a PNG file or all those of a folder, whose units are those of
/// `rig` (else centi-kelvin). Refuses images that change, and recordings of another camera than
/// that of `rig`, which is set to theirs if there is none. `progress` gets the fraction done, 0..1.
Result<MeanImage> ReadMeanImage(const std::filesystem::path& path, std::optional<Rig>& rig,
                                const std::function<void(double)>& progress);

}  // namespace isotherm
