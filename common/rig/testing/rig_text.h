#pragma once

namespace isotherm {

/// A rig file as a calibration writes it, without what has a default.
inline constexpr char kRigText[] = R"(# A rig.
depth { width: 640 height: 480 fx: 567.7 fy: 567.5 cx: 321.3 cy: 242.4 }
depth_scale: 1000
thermal { width: 382 height: 288 fx: 371.4 fy: 372.1 cx: 205.5 cy: 150.5 k1: -0.439 k2: 0.29 }
T_thermal_depth { tx: 0.0485 ty: 0.0533 tz: 0.0115 qx: 0 qy: 0.6 qz: 0 qw: 0.8 }
thermal_delay_s: 0.0125
serial: "PI-450"
)";

}  // namespace isotherm
