#pragma once

#include <cstdint>

#include "ground/calibration/rig_refinement.h"

namespace isotherm::testing {

/// Holds what a scan of a folded wall is like.
struct WallScan {
  std::uint64_t seed = 1;
  double fold = 0.5;  ///< Slope of the wall to both sides of its edge; 0: flat.
  double contrast_k = 6.0;
  /// Above 1: warmer by 150 K, and seen as a smooth dielectric before surroundings at 20 degrees C.
  double refractive_index = 1.0;
  double motion = 1.0;        ///< 0: the rig rests.
  bool turns = true;          ///< It turns and goes nearer and farther, beside its swing.
  double nuc_offset_k = 0.0;  ///< The second half of the scan, after a NUC, is as much warmer.
  double drift_m = 0.0;       ///< Poses wander by so much, one sigma along each axis.
  /// Fractions of what the surroundings of a pixel and the whole image add to it; the calibration
  /// does not know them.
  double near_fraction = 0.0, total_fraction = 0.0;
  double row_readout_s = 0.0;  ///< Stamps are of the middle row.
};

/// The true placement of its thermal camera, with 160 x 120 pixels.
ThermalPlacement TruePlacement();

/// All that the scan offers but visibility. Stamps lack the true delay.
ScanViews ScanOf(const WallScan& scan);

/// Both halves are in sight wherever the rig is.
Status Look(ScanViews& views, const ThermalPlacement& placement);

}  // namespace isotherm::testing
