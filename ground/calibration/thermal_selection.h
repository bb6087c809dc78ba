#pragma once

#include <cstddef>
#include <vector>

#include "ground/calibration/texture_consistency.h"

namespace isotherm {

/// References to a bounded number of a scan's thermal images, spread evenly over it however long it
/// becomes. Of frames that stand for each other the one at the fastest motion is kept: it says most
/// about when it was taken. Thread-compatible.
class ThermalSelection {
 public:
  /// `max_frames` >= 2.
  explicit ThermalSelection(std::size_t max_frames);

  /// Takes the frames in order of capture time. `speed` is that of the image, in any unit, the same
  /// for all.
  void Add(StampedThermal frame, double speed);

  /// Returns the selected frames by time, not more than `max_frames`.
  std::vector<StampedThermal> frames() const;

 private:
  /// Holds a frame and how fast the image moved in it.
  struct Kept {
    StampedThermal frame;
    double speed = 0.0;
  };

  /// Keeps the faster one of each two neighbours.
  void Halve();

  const std::size_t max_frames_;
  std::size_t stride_ = 1;     ///< Frames that each of the kept ones stands for.
  std::size_t in_bucket_ = 0;  ///< Frames that the last one stands for so far.
  std::vector<Kept> kept_;
};

}  // namespace isotherm
