#pragma once

#include <span>
#include <vector>

#include "common/frame/image.h"

namespace isotherm {

/// Weights of the discrete Gaussian (Lindeberg 1990, eq. 19) from the centre outwards; one weight =
/// sharp. Its variance on the pixels' grid is that of the Gaussian, which samples of a narrow one
/// miss by half.
std::vector<float> GaussianWeights(double sigma_px);

/// Blurs the image in both directions. Beyond the border, its pixels are repeated.
void Blur(std::span<const float> weights, Image<float>& image, Image<float>& scratch);

}  // namespace isotherm
