#pragma once

#include <cstdint>
#include <unordered_map>

#include "ground/feedback/model_coverage.h"

namespace isotherm {

/// Keeps which surface that is not yet measured well is out of reach: of all views of it that were
/// tried, none would measure anything well, because it lies too deep, too close to something or
/// behind something, or because views like it were proposed and led to nothing. A piece of surface
/// that grew after it was found out of reach counts as not tried again. Thread-compatible.
class Reach {
 public:
  /// `views` views of this piece (LackingSurface) are about to be tried, once more maybe.
  void Begin(const LackingSurface& surface, int views);
  /// One of its views was tried; `gains` = it would measure enough surface well.
  void Note(std::uint64_t cell, bool gains);

  bool IsOutOfReach(std::uint64_t cell, double area_m2) const;
  /// The surface that is out of reach now, square metres.
  double OutOfReach(const ModelCoverage& coverage) const;

 private:
  /// Says how the views of one cell have fared.
  struct Assessment {
    double area_m2 = 0.0;  ///< When its views began to be tried.
    int views_left = 0;
    bool gains = false;
    bool is_out_of_reach = false;
  };

  std::unordered_map<std::uint64_t, Assessment> assessments_;  ///< By LackingSurface::cell.
};

}  // namespace isotherm
