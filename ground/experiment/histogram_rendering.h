#pragma once

#include <Eigen/Core>

#include "ground/renderer/rgb.h"

namespace isotherm {

/// Draws a histogram of each column of `samples`, three in a row, each over its own range.
RgbImage HistogramRendering(const Eigen::MatrixXd& samples);

}  // namespace isotherm
