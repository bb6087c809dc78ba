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

/// Points, or a line through them, in the units of the axes.
struct GraphSeries {
  std::string name;
  std::vector<Eigen::Vector2d> points{};
  std::vector<double> sigmas{};  ///< Twice these are drawn on both sides. Empty: none.
  bool is_line = false;
};

/// Series over common axes with a legend, SVG.
std::string SvgGraph(const std::vector<GraphSeries>& series, std::string_view x_title,
                     std::string_view y_title);

}  // namespace isotherm
