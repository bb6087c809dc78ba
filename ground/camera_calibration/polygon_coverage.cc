#include "ground/camera_calibration/polygon_coverage.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Sutherland and Hodgman (1974): keeps what is on one side of the line from `from` to `to`.
Polygon ClipAtLine(const Polygon& polygon, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                   double sense) {
  Polygon kept;
  const Eigen::Vector2d edge = to - from;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double side_p = sense * Cross(edge, p - from), side_q = sense * Cross(edge, q - from);
    if (side_p >= 0.0) kept.push_back(p);
    if ((side_p >= 0.0) != (side_q >= 0.0))
      kept.emplace_back(p + (q - p) * (side_p / (side_p - side_q)));
  }
  return kept;
}

/// Adds what a piece of an edge within one row of cells covers of them and of all cells to their
/// right: from (x0, .) to (x1, .), `rise` high with the sign of its direction.
void AddPiece(double x0, double x1, double rise, std::span<float> row) {
  const double last = static_cast<double>(row.size()) - 2.0;
  const double length = x1 - x0;
  double x = x0;
  for (int guard = 0; guard < static_cast<int>(row.size()) + 2; ++guard) {
    // To the next border between cells, or to the end.
    double next = x1;
    if (length > 0.0) next = std::min(x1, std::floor(x) + 1.0);
    if (length < 0.0) next = std::max(x1, std::ceil(x) - 1.0);
    const double part = length == 0.0 ? rise : rise * (next - x) / length;
    const double middle = std::clamp(0.5 * (x + next), 0.0, last + 0.5);
    const double cell = std::min(std::floor(middle), last);
    const double covered = cell + 1.0 - middle;
    row[static_cast<std::size_t>(cell)] += static_cast<float>(part * covered);
    row[static_cast<std::size_t>(cell) + 1] += static_cast<float>(part * (1.0 - covered));
    x = next;
    if (x == x1) return;
  }
}

/// Cuts an edge at the borders between rows. Columns beyond the image count as its first or last.
void AddEdge(const Eigen::Vector2d& p, const Eigen::Vector2d& q, int height, int width,
             std::vector<float>& sums) {
  if (p.y() == q.y()) return;
  const double sign = q.y() > p.y() ? 1.0 : -1.0;
  const Eigen::Vector2d& top = q.y() > p.y() ? p : q;
  const Eigen::Vector2d& bottom = q.y() > p.y() ? q : p;
  const double slope = (bottom.x() - top.x()) / (bottom.y() - top.y());
  const int first = std::max(0, static_cast<int>(std::floor(top.y())));
  const int end = std::min(height, static_cast<int>(std::ceil(bottom.y())));
  const double right = width;
  for (int y = first; y < end; ++y) {
    const double y0 = std::max<double>(y, top.y()), y1 = std::min<double>(y + 1, bottom.y());
    if (y1 <= y0) continue;
    const double x0 = std::clamp(top.x() + slope * (y0 - top.y()), 0.0, right);
    const double x1 = std::clamp(top.x() + slope * (y1 - top.y()), 0.0, right);
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width + 2);
    AddPiece(x0, x1, sign * (y1 - y0),
             std::span(sums).subspan(row, static_cast<std::size_t>(width + 2)));
  }
}

}  // namespace

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double SignedArea(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * sum;
}

Eigen::Vector2d Centroid(const Polygon& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // Relative to a corner: products of large coordinates would lose digits.
    const Eigen::Vector2d p = polygon[i] - polygon[0];
    const Eigen::Vector2d q = polygon[(i + 1) % polygon.size()] - polygon[0];
    const double part = Cross(p, q);
    sum += part * (p + q);
    area += part;
  }
  return polygon[0] + sum / (3.0 * area);
}

Polygon Intersect(const Polygon& subject, const Polygon& clip) {
  Polygon result = subject;
  const double sense = SignedArea(clip) > 0.0 ? 1.0 : -1.0;
  for (std::size_t i = 0; i < clip.size() && !result.empty(); ++i)
    result = ClipAtLine(result, clip[i], clip[(i + 1) % clip.size()], sense);
  return result;
}

void Cover(const Polygon& polygon, Image<float>& coverage) {
  const int width = coverage.width(), height = coverage.height();
  // What edges add: to their cell, and to all cells right of it by a running sum.
  std::vector<float> sums(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < polygon.size(); ++i)
    AddEdge(polygon[i], polygon[(i + 1) % polygon.size()], height, width, sums);
  const float sign = SignedArea(polygon) > 0.0 ? -1.0F : 1.0F;
  for (int y = 0; y < height; ++y) {
    const float* const row =
        sums.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width + 2);
    float sum = 0.0F;
    for (int x = 0; x < width; ++x) {
      sum += row[x];
      coverage.At(x, y) = sign * sum;
    }
  }
}

}  // namespace isotherm
