#include "ground/camera_calibration/grid_growth.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <set>
#include <utility>

#include "ground/camera_calibration/polygon_coverage.h"

namespace isotherm {
namespace {

using Cell = std::pair<int, int>;
using Points = std::vector<Eigen::Vector2d>;
/// Index of the point in each cell of the lattice.
using Lattice = std::map<Cell, int>;

/// The point nearest to `p` within `reach`, or -1.
int Nearest(const Points& points, const Eigen::Vector2d& p, double reach) {
  int nearest = -1;
  double best = reach;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i] - p).norm();
    if (distance >= best) continue;
    best = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

/// Steps to the nearest neighbour of a point and to the nearest in about another direction.
std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> Steps(const Points& points, int from) {
  const Eigen::Vector2d& origin = points[static_cast<std::size_t>(from)];
  Points arms;
  for (const Eigen::Vector2d& p : points)
    if (p != origin) arms.emplace_back(p - origin);
  std::sort(arms.begin(), arms.end(),
            [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  // The eight around a point of a grid; one of them leads along the other direction.
  constexpr std::size_t kNeighbours = 8;
  constexpr double kMinSine = 0.5, kMaxRatio = 2.2;  // A board seen at up to 60 degrees.
  for (std::size_t i = 1; i < std::min(kNeighbours, arms.size()); ++i) {
    if (arms[i].norm() > kMaxRatio * arms[0].norm()) break;
    if (std::abs(Cross(arms[0], arms[i])) > kMinSine * arms[0].norm() * arms[i].norm())
      return std::pair(arms[0], arms[i]);
  }
  return std::nullopt;
}

/// All cells that steps lead to. Each step is as long as the last one in its direction, so that
/// perspective and a bending lens are followed.
Lattice Grow(const Points& points, int from, const Eigen::Vector2d& right,
             const Eigen::Vector2d& down) {
  struct Front {
    Cell cell;
    Eigen::Vector2d right, down;
  };
  Lattice lattice = {{{0, 0}, from}};
  std::set<int> used = {from};
  std::deque<Front> fronts = {{{0, 0}, right, down}};
  // Of a step. Below a half, so that no two cells claim one point; more than perspective and lens
  // change a step from one cell to the next.
  constexpr double kReach = 0.3;
  while (!fronts.empty()) {
    const Front front = fronts.front();
    fronts.pop_front();
    const Eigen::Vector2d& at = points[static_cast<std::size_t>(lattice[front.cell])];
    for (const auto& [dx, dy] : {Cell(1, 0), Cell(-1, 0), Cell(0, 1), Cell(0, -1)}) {
      const Cell cell(front.cell.first + dx, front.cell.second + dy);
      if (lattice.contains(cell)) continue;
      const Eigen::Vector2d step = dx * front.right + dy * front.down;
      const int next = Nearest(points, at + step, kReach * step.norm());
      if (next < 0 || used.contains(next)) continue;
      lattice[cell] = next;
      used.insert(next);
      Front further{cell, front.right, front.down};
      const Eigen::Vector2d went = points[static_cast<std::size_t>(next)] - at;
      (dx != 0 ? further.right : further.down) = (dx + dy) * went;
      fronts.push_back(further);
    }
  }
  return lattice;
}

/// Cells with the least coordinates 0.
Lattice FromZero(const Lattice& lattice) {
  int x0 = lattice.begin()->first.first, y0 = lattice.begin()->first.second;
  for (const auto& [cell, point] : lattice) {
    x0 = std::min(x0, cell.first);
    y0 = std::min(y0, cell.second);
  }
  Lattice moved;
  for (const auto& [cell, point] : lattice) moved[{cell.first - x0, cell.second - y0}] = point;
  return moved;
}

Cell Extent(const Lattice& lattice) {
  Cell extent(0, 0);
  for (const auto& [cell, point] : lattice)
    extent = {std::max(extent.first, cell.first + 1), std::max(extent.second, cell.second + 1)};
  return extent;
}

/// The lattice in columns and rows. A tilted grid's nearest neighbours may be those of the next row
/// or of the same; the steps along rows and columns are those in which it fills a rectangle. Rows
/// of an asymmetric grid have a point in every second column only.
Lattice Upright(const Lattice& lattice, bool asymmetric) {
  Lattice best;
  double best_fill = 0.0;
  constexpr int kWays = 81;  // All matrices of -1, 0 and 1.
  for (int way = 0; way < kWays; ++way) {
    const int a = way % 3 - 1, b = way / 3 % 3 - 1, c = way / 9 % 3 - 1, d = way / 27 - 1;
    if (std::abs(a * d - b * c) != 1) continue;
    Lattice turned;
    for (const auto& [cell, point] : lattice) {
      const int i = a * cell.first + b * cell.second, j = c * cell.first + d * cell.second;
      turned[asymmetric ? Cell(i + j, j - i) : Cell(i, j)] = point;
    }
    turned = FromZero(turned);
    const Cell extent = Extent(turned);
    const double fill = static_cast<double>(turned.size()) / (extent.first * extent.second);
    if (fill <= best_fill) continue;
    best_fill = fill;
    best = std::move(turned);
  }
  return best;
}

/// Adds points that steps did not lead to, as to the corners of an asymmetric grid, which have one
/// neighbour only: where a homography through all others puts them.
Lattice Complete(const Lattice& lattice, const Points& points, bool asymmetric) {
  std::vector<cv::Point2d> cells, pixels;
  std::set<int> used;
  for (const auto& [cell, point] : lattice) {
    cells.emplace_back(cell.first, cell.second);
    const Eigen::Vector2d& p = points[static_cast<std::size_t>(point)];
    pixels.emplace_back(p.x(), p.y());
    used.insert(point);
  }
  const cv::Mat homography = cv::findHomography(cells, pixels);
  if (homography.empty()) return lattice;
  const auto at = [&](double x, double y) {
    const cv::Vec3d p = cv::Mat(homography * cv::Vec3d(x, y, 1.0));
    return Eigen::Vector2d(p[0] / p[2], p[1] / p[2]);
  };
  Lattice complete = lattice;
  const Cell extent = Extent(lattice);
  const int parity =
      asymmetric ? (lattice.begin()->first.first + lattice.begin()->first.second) % 2 : 0;
  constexpr double kReach = 0.35;  // Of the distance to the next cell.
  for (int y = -1; y <= extent.second; ++y) {
    for (int x = -1; x <= extent.first; ++x) {
      if (lattice.contains({x, y}) || (asymmetric && std::abs(x + y) % 2 != parity)) continue;
      const double step = (at(x, y) - at(x + 1, y)).norm();
      const int point = Nearest(points, at(x, y), kReach * step);
      if (point >= 0 && used.insert(point).second) complete[{x, y}] = point;
    }
  }
  return FromZero(complete);
}

/// One of the eight ways to lay a grid on itself.
Lattice Reorient(const Lattice& lattice, int way) {
  const Cell extent = Extent(lattice);
  Lattice turned;
  for (const auto& [cell, point] : lattice) {
    const int x = (way & 1) != 0 ? extent.first - 1 - cell.first : cell.first;
    const int y = (way & 2) != 0 ? extent.second - 1 - cell.second : cell.second;
    turned[(way & 4) != 0 ? Cell(y, x) : Cell(x, y)] = point;
  }
  return turned;
}

/// The features of a target in such a grid; empty if a cell is missing or too many.
Points Read(const Lattice& lattice, const Points& points, const CalibrationTarget& target) {
  if (static_cast<int>(lattice.size()) != target.features()) return {};
  const bool asymmetric = target.pattern == CalibrationTarget::Pattern::kAsymmetricCircles;
  Points features;
  for (int i = 0; i < target.features(); ++i) {
    const int row = i / target.columns, column = i % target.columns;
    const auto found =
        lattice.find(asymmetric ? Cell(2 * column + row % 2, row) : Cell(column, row));
    if (found == lattice.end()) return {};
    features.push_back(points[static_cast<std::size_t>(found->second)]);
  }
  return features;
}

/// The parts of a lattice, `width` x `height` cells each, in which no point is missing.
std::vector<Lattice> FullParts(const Lattice& lattice, int width, int height, int points) {
  std::vector<Lattice> parts;
  const Cell extent = Extent(lattice);
  for (int y = 0; y + height <= extent.second; ++y) {
    for (int x = 0; x + width <= extent.first; ++x) {
      Lattice part;
      for (const auto& [cell, point] : lattice) {
        const Cell in(cell.first - x, cell.second - y);
        if (in.first >= 0 && in.second >= 0 && in.first < width && in.second < height)
          part[in] = point;
      }
      if (static_cast<int>(part.size()) == points) parts.push_back(std::move(part));
    }
  }
  return parts;
}

/// Returns the target in a lattice to which things beside it were taken by mistake: the only part
/// of its size in which nothing is missing. A larger target has several.
Lattice WithoutOthers(const Lattice& lattice, const CalibrationTarget& target) {
  const bool asymmetric = target.pattern == CalibrationTarget::Pattern::kAsymmetricCircles;
  const int across = asymmetric ? 2 * target.columns : target.columns;
  std::vector<Lattice> parts = FullParts(lattice, across, target.rows, target.features());
  for (Lattice& part : FullParts(lattice, target.rows, across, target.features()))
    parts.push_back(std::move(part));
  return parts.size() == 1 ? parts.front() : lattice;
}

bool IsClockwise(const Points& features, const CalibrationTarget& target) {
  const auto last = features.size() - static_cast<std::size_t>(target.columns);
  return Cross(features[static_cast<std::size_t>(target.columns - 1)] - features.front(),
               features[last] - features.front()) > 0.0;
}

void Number(const Lattice& lattice, const Points& points, const CalibrationTarget& target,
            GrownGrid& grid) {
  for (int way = 0; way < 8; ++way) {
    Points features = Read(Reorient(lattice, way), points, target);
    if (features.empty()) continue;
    if (IsClockwise(features, target)) {
      grid.features = std::move(features);
      grid.mirrored = false;
      return;
    }
    grid.mirrored = true;
  }
}

}  // namespace

std::optional<GrownGrid> GrowGrid(const std::vector<Eigen::Vector2d>& points,
                                  const CalibrationTarget& target) {
  // From the middle, where neighbours are on all sides and steps change least.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) middle += p / static_cast<double>(points.size());
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return (points[static_cast<std::size_t>(a)] - middle).squaredNorm() <
           (points[static_cast<std::size_t>(b)] - middle).squaredNorm();
  });
  // Points near the middle to begin at: a start beside a stray or a missing point fails. Not tuned.
  constexpr std::size_t kTries = 12;
  Lattice best;
  for (std::size_t i = 0; i < std::min(kTries, order.size()); ++i) {
    const auto steps = Steps(points, order[i]);
    if (!steps) continue;
    Lattice lattice = Grow(points, order[i], steps->first, steps->second);
    if (lattice.size() > best.size()) best = std::move(lattice);
    if (best.size() == points.size()) break;
  }
  // 3 by 3: the least that shows which way rows and columns run. Smaller: clutter passes.
  constexpr std::size_t kMinPoints = 9;
  if (best.size() < kMinPoints) return std::nullopt;
  const bool asymmetric = target.pattern == CalibrationTarget::Pattern::kAsymmetricCircles;
  const Lattice lattice =
      WithoutOthers(Complete(Upright(best, asymmetric), points, asymmetric), target);
  const Cell extent = Extent(lattice);
  GrownGrid grid;
  grid.columns = extent.first;
  grid.rows = extent.second;
  // An asymmetric grid has twice as many columns of cells as features in a row.
  const auto size = [&](int across, int along) {
    return Cell(asymmetric ? across / 2 : across, along);
  };
  const Cell expected(target.columns, target.rows);
  const Cell one = size(extent.first, extent.second), other = size(extent.second, extent.first);
  const auto misfit = [&](const Cell& c) {
    // Whole pairs of columns only.
    const int missing =
        asymmetric ? std::abs(extent.first * extent.second - 2 * c.first * c.second) : 0;
    return std::abs(c.first - expected.first) + std::abs(c.second - expected.second) + 10 * missing;
  };
  std::tie(grid.columns, grid.rows) = misfit(one) <= misfit(other) ? one : other;
  grid.points = static_cast<int>(lattice.size());
  Number(lattice, points, target, grid);
  return grid;
}

}  // namespace isotherm
