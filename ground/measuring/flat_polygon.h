#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace isotherm {

/// Area of a polygon by the shoelace formula; positive if its corners go counter-clockwise.
double SignedArea(std::span<const Eigen::Vector2d> polygon);

/// Returns which fraction of a triangle lies inside a polygon without self-intersections, convex or
/// not: the polygon is cut by the triangle's three sides (I. Sutherland, G. Hodgman, "Reentrant
/// polygon clipping", 1974), and bridges that this leaves have no area.
double FractionInside(const std::array<Eigen::Vector2d, 3>& triangle,
                      std::span<const Eigen::Vector2d> polygon);

}  // namespace isotherm
