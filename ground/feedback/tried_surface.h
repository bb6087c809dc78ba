#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>

namespace isotherm {

/// Keeps which surface was looked at under good conditions, hardly moving, again and again, and
/// still is not measured well: beside edges, where temperatures are steep, or where something hides
/// it. It is not worth another view. In cells of one and a half centimetres. Thread-compatible.
class TriedSurface {
 public:
  /// Another look begins: a cell counts once in each.
  void BeginLook() { ++look_; }
  /// A point was looked at so, and is measured well now or not. `piece` is the LackingSurface that
  /// it belongs to.
  void Note(const Eigen::Vector3d& p_map, std::uint64_t piece, bool is_well);
  /// Returns whether another look there would not help.
  bool IsVain(const Eigen::Vector3d& p_map) const;
  /// The part of a piece of surface that is not worth another view, square metres.
  double VainArea(std::uint64_t piece) const;

 private:
  /// Says how often a cell was looked at.
  struct Cell {
    std::uint64_t piece = 0;
    int looks = 0;
    int last_look = 0;  ///< In which something was lacking.
  };
  int look_ = 0;
  std::unordered_map<std::uint64_t, Cell> cells_;
  std::unordered_map<std::uint64_t, int>
      vain_;  ///< Number of cells that another look would not help, by piece.
};

}  // namespace isotherm
