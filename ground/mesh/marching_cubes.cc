#include "ground/mesh/marching_cubes.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace isotherm {
namespace {

using Edges = std::array<CubeEdge, kCubeEdges>;
using Loop = std::vector<std::uint8_t>;

constexpr int kNone = -1;

/// Corners of each face, counter-clockwise seen from outside the cube.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// All edges, sorted by axis, then by their first corner.
Edges MakeEdges() {
  Edges edges;
  std::size_t count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < kCubeCorners; ++corner) {
      if ((corner >> axis & 1) == 0) edges[count++] = {corner, axis};
    }
  }
  return edges;
}

int EdgeBetween(const Edges& edges, int a, int b) {
  const auto found = std::ranges::find_if(edges, [&](const CubeEdge& edge) {
    return edge.from == std::min(a, b) && edge.to() == std::max(a, b);
  });
  CHECK(found != edges.end());
  return static_cast<int>(found - edges.begin());
}

bool SharesFace(const Edges& edges, int a, int b) {
  return std::ranges::any_of(kFaces, [&](const std::array<int, 4>& face) {
    const auto on_face = [&](const CubeEdge& edge) {
      return std::ranges::find(face, edge.from) != face.end() &&
             std::ranges::find(face, edge.to()) != face.end();
    };
    return on_face(edges[static_cast<std::size_t>(a)]) &&
           on_face(edges[static_cast<std::size_t>(b)]);
  });
}

/// Walking around a face, the boundary enters the inside on one edge and leaves it on a later one;
/// the surface connects the two. An edge has two faces, which walk it in opposite directions, so
/// that it is entered in one and left in the other: following entered -> left closes loops.
std::array<int, kCubeEdges> NextCrossings(const Edges& edges, int inside) {
  std::array<int, kCubeEdges> next;
  next.fill(kNone);
  const auto is_inside = [inside](int corner) { return (inside >> corner & 1) != 0; };
  for (const std::array<int, 4>& face : kFaces) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (is_inside(face[i]) || !is_inside(face[(i + 1) % 4])) continue;
      std::size_t last = (i + 1) % 4;
      while (is_inside(face[(last + 1) % 4])) last = (last + 1) % 4;
      const int entered = EdgeBetween(edges, face[i], face[(i + 1) % 4]);
      const int left = EdgeBetween(edges, face[last], face[(last + 1) % 4]);
      next[static_cast<std::size_t>(entered)] = left;
    }
  }
  return next;
}

std::vector<Loop> FindLoops(const Edges& edges, int inside) {
  std::array<int, kCubeEdges> next = NextCrossings(edges, inside);
  std::vector<Loop> loops;
  for (int start = 0; start < kCubeEdges; ++start) {
    Loop loop;
    for (int edge = start; next[static_cast<std::size_t>(edge)] != kNone;) {
      loop.push_back(static_cast<std::uint8_t>(edge));
      edge = std::exchange(next[static_cast<std::size_t>(edge)], kNone);
    }
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  return loops;
}

/// Cuts the polygon loop[first..last] into triangles without a diagonal in a face, by trying each
/// third corner for the side (first, last). Returns false if there is no way.
bool Triangulate(const Edges& edges, const Loop& loop, std::size_t first, std::size_t last,
                 std::vector<CubeTriangle>& triangles) {
  if (last - first < 2) return true;
  const auto allowed = [&](std::size_t a, std::size_t b) {
    const bool side = b - a == 1 || (a == 0 && b == loop.size() - 1);
    return side || !SharesFace(edges, loop[a], loop[b]);
  };
  const std::size_t before = triangles.size();
  for (std::size_t middle = first + 1; middle < last; ++middle) {
    if (!allowed(first, middle) || !allowed(middle, last)) continue;
    triangles.push_back({loop[first], loop[middle], loop[last]});
    if (Triangulate(edges, loop, first, middle, triangles) &&
        Triangulate(edges, loop, middle, last, triangles)) {
      return true;
    }
    triangles.resize(before);
  }
  return false;
}

}  // namespace

MarchingCubesTable::MarchingCubesTable() : edges_(MakeEdges()) {
  for (int inside = 0; inside < 256; ++inside) {
    for (const Loop& loop : FindLoops(edges_, inside)) {
      CHECK(Triangulate(edges_, loop, 0, loop.size() - 1,
                        triangles_[static_cast<std::size_t>(inside)]));
    }
  }
}

}  // namespace isotherm
