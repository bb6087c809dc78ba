#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/frame/image.h"

namespace isotherm {

/// Returns the third component of the cross product of two vectors in a plane.
double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// The corners of a convex polygon, in order.
using Polygon = std::vector<Eigen::Vector2d>;

/// The part that two convex polygons share, both in the same sense of rotation; empty if none.
Polygon Intersect(const Polygon& subject, const Polygon& clip);

/// Twice the signed area is positive if the corners go from x to y.
double SignedArea(const Polygon& polygon);
Eigen::Vector2d Centroid(const Polygon& polygon);

/// Sets each cell to the fraction of its area that the polygon covers. Cell (x, y) is the square
/// [x, x + 1) x [y, y + 1); what lies beyond the image is cut off.
void Cover(const Polygon& polygon, Image<float>& coverage);

}  // namespace isotherm
