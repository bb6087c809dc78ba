#include <gtest/gtest.h>
#include <isotherm_frames.h>

#include "common/transport/conversions.h"

namespace isotherm {
namespace {

RigDescription SomeRig() {
  RigDescription description;
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  description.rig.depth = camera;
  description.rig.depth_sensor.near_range_m = 0.5;
  description.rig.thermal_sensor.row_readout_s = 1e-4;
  return description;
}

TEST(ConvertRigTest, SensorsArriveAsTheyWereWritten) {
  isotherm_wire_Rig wire{};
  ToWire(SomeRig(), &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.depth_sensor.near_range_m, 0.5);
  EXPECT_EQ(received.rig.thermal_sensor.row_readout_s, 1e-4);
  EXPECT_FALSE(received.rig.thermal_sensor.pixel_pitch_m.has_value());
  EXPECT_FALSE(received.rig.thermal_sensor.lens.has_value());
}

/// What ends before them, or within them, reads as zeros from there on.
TEST(ConvertRigTest, AnEdgeBefore22HasTheSensorsOfAnOldRigFile) {
  isotherm_wire_Rig wire{};
  ToWire(SomeRig(), &wire);
  wire.thermal_sensor = {};
  wire.has_sensors = false;
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.depth_sensor.near_range_m, DepthSensorModel().near_range_m);
  EXPECT_EQ(received.rig.thermal_sensor.time_constant_s, ThermalSensorModel().time_constant_s);
}

TEST(ConvertRigTest, SensorsThatCannotBeAreRefused) {
  isotherm_wire_Rig wire{};
  ToWire(SomeRig(), &wire);
  wire.depth_sensor.noise_at_1m_m = -1.0;
  RigDescription received;
  EXPECT_EQ(FromWire(wire, &received), RefusalCause::kOutOfRange);
}

}  // namespace
}  // namespace isotherm
