#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace isotherm {

/// Corner c of a cube is at (c & 1, c >> 1 & 1, c >> 2 & 1).
inline constexpr int kCubeCorners = 8;
inline constexpr int kCubeEdges = 12;

/// An edge of the cube: from corner `from` one step along `axis` (0 x, 1 y, 2 z).
struct CubeEdge {
  int from = 0;
  int axis = 0;
  int to() const { return from | (1 << axis); }
};

/// Three edge numbers, counter-clockwise seen from outside.
using CubeTriangle = std::array<std::uint8_t, 3>;

/// Lists which triangles cut a cube, for each of the 256 ways its corners can be inside (negative)
/// or outside. Derived from one rule instead of a printed table: on a face with two diagonal
/// corners inside, each is cut off by itself. Both cubes at a face see the same face, so the
/// surface is closed; no triangle side lies across a face unless it bounds the surface there, so
/// exactly two triangles meet at each side. Immutable after construction.
class MarchingCubesTable {
 public:
  MarchingCubesTable();

  const std::array<CubeEdge, kCubeEdges>& edges() const { return edges_; }
  /// Bit c of `inside` = corner c is inside.
  const std::vector<CubeTriangle>& triangles(int inside) const {
    return triangles_[static_cast<std::size_t>(inside)];
  }

 private:
  std::array<CubeEdge, kCubeEdges> edges_;
  std::array<std::vector<CubeTriangle>, 256> triangles_;
};

}  // namespace isotherm
