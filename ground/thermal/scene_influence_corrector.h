#pragma once

#include <vector>

#include "common/frame/image.h"
#include "common/rig/sensor_models.h"

namespace isotherm {

/// Where a pixel lies between the middles of two cells of a row or column.
struct CellInterpolation {
  int first = 0, second = 0;
  float fraction = 0.0F;
};

/// Holds the means that a correction rested on, of the pixels' own temperatures, °C.
struct InfluenceMeans {
  Image<float> near;  ///< By cell of SceneInfluenceCorrector::kCellPixels.
  float total = 0.0F;

  /// The mean around a place of the image, pixels.
  float NearAt(double x, double y) const;
};

/// Takes out of thermal images what the radiation on other pixels adds to each one (thesis 5.1):
///
///   measured = own + near_fraction (near - own) + total_fraction (total - own)
///
/// in temperature, where `near` is the mean of the surroundings, weighted by a Gaussian of
/// near_sigma_px, and `total` the mean of the image, both over pixels with a value. The means are
/// so smooth that they are found, and the equation solved, on cells of 8 x 8 pixels. Thread-bound.
class SceneInfluenceCorrector {
 public:
  /// Side of the cells in which the means are found. The near mean has a sigma of 40 px, so that
  /// cells of 8 lose nothing that shows (0.01 K in the scene-influence experiment); smaller ones
  /// cost time by the square.
  static constexpr int kCellPixels = 8;

  /// `influence` is valid, images have this size.
  SceneInfluenceCorrector(const SceneInfluence& influence, int width, int height);

  /// Turns measured temperatures into the pixels' own, °C; NaN is "no value" and stays so.
  void Correct(Image<float>& celsius);

  /// Returns the means of the last image.
  InfluenceMeans means() const { return {near_, total_}; }

 private:
  /// own = gain (measured - near_fraction near - total).
  struct CorrectionTerms {
    float near_fraction, total, gain;
  };

  void AverageCells(const Image<float>& celsius);
  /// The sum around each cell, weighted by the Gaussian; outside of the image there is nothing.
  void SumNeighbourhoods(const Image<float>& cells, Image<float>& sums);
  /// The near mean of `values_`, into `near_`.
  void AverageNeighbourhoods();
  /// The total mean of `values_`.
  float AverageAll() const;
  void Subtract(const CorrectionTerms& terms, Image<float>& celsius);

  const SceneInfluence influence_;
  float total_ = 0.0F;
  const int columns_, rows_;               ///< Number of cells.
  std::vector<float> weights_;             ///< The Gaussian, from the middle outwards, in cells.
  Image<float> measured_;                  ///< Mean of each cell.
  Image<float> coverage_;                  ///< Number of pixels with a value in each cell.
  Image<float> values_, near_;             ///< The unknowns: own temperatures and their near mean.
  Image<float> divisors_;                  ///< The sum of `coverage_` around each cell.
  Image<float> covered_, row_sums_;        ///< Scratch of SumNeighbourhoods and its caller.
  std::vector<CellInterpolation> across_;  ///< By column of pixels.
  std::vector<float> near_row_;            ///< By column of cells, for one row of pixels.
};

}  // namespace isotherm
