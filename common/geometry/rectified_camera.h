#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/geometry/camera.h"

namespace isotherm {

/// The pixel in which `camera` sees what is at normalised image coordinates; nullopt outside its
/// image, also where the distortion's polynomial folds back into the image what the lens never saw.
std::optional<Eigen::Vector2d> ProjectIntoImage(const CameraModel& camera,
                                                const Eigen::Vector2d& normalized);

/// The camera without distortion whose image holds all that `camera` sees: the undistorted border
/// of its image lies inside, but for what is more than 70 degrees from the axis. Its pixels are
/// those of `camera` at the principal point, as large and at whole offsets. Where the border needs
/// an image whose sides are more than half as long again, the focal length is shortened instead.
CameraModel RectifiedCamera(const CameraModel& camera);

}  // namespace isotherm
