#pragma once

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/camera_motion.h"

namespace isotherm {

/// Returns the smear that a measurement taken now would have, in thermal pixels: how far each
/// surface point of `maps` goes through the thermal image while a pixel follows a change of
/// temperature, with the shift by the read-out. It is NaN where there is no surface or the thermal
/// camera does not see it through its lens. `thermal` is the camera as calibrated, `motion` its own
/// (MotionOf). Pixels are those of the middle of the image, and rows those in which the lens shows
/// a point, as for the fuser (thermal.expert.motion).
Image<float> SmearInView(const SurfaceMaps& maps, const RigidTransform& T_map_thermal,
                         const CameraMotion& motion, const CameraModel& thermal,
                         const ThermalSensorModel& sensor);

}  // namespace isotherm
