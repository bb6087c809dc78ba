#pragma once

#include <vector>

#include "common/frame/image.h"
#include "ground/camera_calibration/target.h"

namespace isotherm {

/// Turns depth images of one pose of a target with holes into an image of the holes, as a camera
/// would take it: 0 on the board's face, 1 in its holes and beside it, the mean of the images
/// between. The face is the plane in which DetectTarget finds the target; if it does in none, the
/// nearest large one. The images, one or more of one size (CHECK), are in millimetres; NaN has no
/// value.
Image<float> BoardImage(const std::vector<Image<float>>& depth_mm, const CalibrationTarget& target);

}  // namespace isotherm
