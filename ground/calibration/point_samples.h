#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ground/calibration/alignment_equations.h"
#include "ground/calibration/thermal_placement.h"
#include "ground/calibration/trajectory_drift.h"

namespace isotherm {

/// Holds what one frame shows of one point.
struct PointSample {
  double kelvin = 0.0;
  Eigen::Vector2d gradient_k_m;  ///< Along the surface.
  /// Where on the surface the pixel of the point lies after a correction, metres per unit.
  Eigen::Matrix<double, 2, kPlacementParameters> shift;
  /// Kelvin per unit of kNearInfluence and kTotalInfluence (OwnTemperatures::ByFractions).
  Eigen::Vector2d by_influence;
  Eigen::Matrix<double, 2, TrajectoryDrift::kPerKnot> drift_shift;  ///< The same by a knot.
  TrajectoryDrift::Place drift;
  double pixels_per_metre = 0.0;
  double reflectivity = 0.0;  ///< A dielectric surface's, seen at this emission angle.
  int part = 0;
  std::uint8_t epoch = 0;
  bool held_out = false;
};

/// Says how the temperature changes along the surface at a point, by the frames that are not held
/// out.
struct PointTexture {
  Eigen::Vector2d gradient_k_m = Eigen::Vector2d::Zero();
  double mean_slope_k_px = 0.0;  ///< The mean of single images' own gradients.
  bool is_significant = false;   ///< The gradient is above what noise makes.
};

/// The samples [begin, end) of a point between two NUCs, and what they are compared with: a
/// temperature and its change with the emission angle, fitted to those that are not held out.
struct PointEpoch {
  std::size_t begin = 0, end = 0;
  double count = 0.0;  ///< Samples that are not held out; the rest is about them.
  double kelvin = 0.0, reflectivity = 0.0;  ///< Means.
  double kelvin_by_reflectivity = 0.0;
  double reflectivity_squares = 0.0;  ///< Sum over the samples, about the mean.
  double squares = 0.0;               ///< Sum over the differences, K^2.

  double Difference(const PointSample& sample) const {
    return sample.kelvin - kelvin - kelvin_by_reflectivity * (sample.reflectivity - reflectivity);
  }
};

/// nullopt if too few frames show the point.
std::optional<PointTexture> TextureOf(const std::vector<PointSample>& samples);

/// The samples are in order of time. Epochs that few frames show are left out.
std::vector<PointEpoch> EpochsOf(const std::vector<PointSample>& samples);

/// How far one sample differs from what others say, noise included, K^2; nullopt without epochs.
std::optional<double> VarianceOf(const std::vector<PointEpoch>& epochs);

/// Weighs a difference, 1/K^2: by how far samples differ from each other, and by what half a
/// pixel of misalignment makes at an edge, which must not outweigh everything else.
std::optional<double> WeightOf(const PointTexture& texture, const std::vector<PointEpoch>& epochs);

/// Adds a point's samples of one epoch: the lower half of the information, and the gradients of the
/// parts. With the drift if the equations have more than a placement's parameters.
void AddEpoch(const std::vector<PointSample>& samples, const PointEpoch& epoch,
              const PointTexture& texture, double weight, AlignmentEquations& equations);

}  // namespace isotherm
