#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "common/testing/kernel_checks.h"
#include "ground/surface/upsample_kernel.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Both;
using testing::Tribool;

/// Holds a surface point and its normal in double precision.
struct Vertex {
  Eigen::Vector3d p, n;
};

inline Vertex At(const SurfaceMaps& maps, int x, int y) {
  return {Eigen::Vector3d(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y)),
          Eigen::Vector3d(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y))};
}

inline Tribool OnOneSurface(const Vertex& a, const Vertex& b, double max_distance) {
  const auto within = [&](const Eigen::Vector3d& n) {
    return AtLeastZero(max_distance - std::abs(n.dot(b.p - a.p)), testing::kSinglePrecision);
  };
  return Both(within(a.n), within(b.n));
}

/// Holds what UpsampleRow must make of a fine pixel.
struct FinePixel {
  Tribool has_vertex = Tribool::kYes;
  Vertex vertex;
  double distance_with = 0.0;     ///< If there is a vertex,
  double distance_without = 0.0;  ///< and if not.
};

inline FinePixel UpsamplePixel(const UpsampleRowArgs& args, int x, int y) {
  // The coarse pixels around, the first is upper left; some are the same in even rows and columns.
  std::vector<Vertex> around;
  for (const int row : {y / 2, (y + 1) / 2}) {
    for (const int column : {x / 2, (x + 1) / 2}) around.push_back(At(*args.coarse, column, row));
  }
  FinePixel result;
  const double max_distance = args.max_plane_distance_m;
  for (const Vertex& other : around)
    result.has_vertex = Both(result.has_vertex, OnOneSurface(around[0], other, max_distance));
  result.has_vertex = Both(result.has_vertex, OnOneSurface(around[1], around[2], max_distance));
  const Eigen::Vector3d position = Eigen::Map<const Eigen::Vector3f>(args.position).cast<double>();
  result.vertex = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  result.distance_without = std::numeric_limits<float>::max();
  for (const Vertex& vertex : around) {
    result.vertex.p += 0.25 * vertex.p;
    result.vertex.n += 0.25 * vertex.n;
    const double distance = (vertex.p - position).norm();
    if (distance < result.distance_without) result.distance_without = distance;
  }
  result.vertex.n.normalize();
  result.distance_with = (result.vertex.p - position).norm();
  return result;
}

}  // namespace isotherm::reference
