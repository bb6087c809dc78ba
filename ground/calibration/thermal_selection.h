#pragma once

#include <cstddef>
#include <vector>

#include "common/frame/frame.h"

namespace isotherm {

/// References to a bounded number of a scan's thermal frames, spread evenly over it however long it
/// becomes. Of frames that stand for each other the one at the fastest motion is kept: it says most
/// about when it was taken. Thread-compatible.
class ThermalSelection {
 public:
  /// `most` >= 2.
  explicit ThermalSelection(std::size_t max_frames);

  /// In order of capture time. `speed`: of the image, in any unit, the same for all.
  void Add(ThermalFramePtr frame, double speed);

  /// By time; not more than `most`.
  std::vector<ThermalFramePtr> frames() const;

 private:
  struct Kept {
    ThermalFramePtr frame;
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
