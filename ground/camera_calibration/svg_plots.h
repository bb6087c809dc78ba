#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "ground/camera_calibration/projection_map.h"

namespace isotherm {

/// The lengths of a map as a coloured image with a scale, SVG.
std::string SvgMap(const ProjectionMap& map, std::string_view unit);

/// Where features lay in the image, each with its residual `magnified` times as long, SVG.
std::string SvgFeatures(const std::vector<Eigen::Vector2d>& features_px,
                        const std::vector<Eigen::Vector2d>& residuals_px,
                        const Eigen::Vector2i& size_px, double magnified);

/// A histogram of values with a mark at `marked`, SVG.
std::string SvgHistogram(const Eigen::VectorXd& values, double marked, std::string_view title);

}  // namespace isotherm
