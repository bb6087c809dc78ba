#pragma once

#include <optional>
#include <vector>

#include "common/frame/image.h"
#include "ground/camera_calibration/bundle.h"
#include "ground/camera_calibration/target.h"

namespace isotherm {

/// Holds what all images of holes by one camera have in common, as far as it is known.
struct HoleAppearance {
  double diameter_m = 0.0;  ///< Or side.
  bool size_known = false;  ///< Else each image of a hole also tells its size.
  /// Whether the wall of a hole looks like the board (0), like what is behind it (1), or between.
  double wall_fill = 0.0;
  bool wall_known = false;  ///< Else each image of a hole in a thick board tells it.
  double blur_px = 0.6;     ///< About.
};

/// Holds what one image of a feature tells.
struct FeatureMeasurement {
  FeatureObservation observation;
  double blur_px = 0.0;
  double scale = 1.0;  ///< The hole's size over what was assumed.
  double wall_fill = 0.0, wall_sigma = 0.0;
  double contrast = 0.0;
  double noise = 0.0;
};

/// Measures where a camera sees the centre of a hole, by fitting the outline that the present
/// calibration predicts (FitBlob): front rim and, in a thick layer, the back rim that hides a part
/// of it, sampled and projected. `near_px` is the centre of its image as it was found. nullopt if
/// it cannot be measured.
std::optional<FeatureMeasurement> MeasureHole(const Image<float>& image, const BundleState& state,
                                              const CalibrationTarget& target,
                                              const HoleAppearance& hole, int camera, int view,
                                              int feature, const Eigen::Vector2d& near_px);

/// Refines the corners of a chessboard in the image, by the gradients around them.
std::vector<FeatureMeasurement> MeasureCorners(const Image<float>& image,
                                               const std::vector<Eigen::Vector2d>& near_px,
                                               const CalibrationTarget& target, int camera,
                                               int view);

/// The holes' size from an image in which they were found, before anything else is known: where the
/// brightness crosses the middle between hole and board, on the way to the neighbours.
double GuessHoleSize(const Image<float>& image, const CalibrationTarget& target,
                     const std::vector<Eigen::Vector2d>& features);

}  // namespace isotherm
