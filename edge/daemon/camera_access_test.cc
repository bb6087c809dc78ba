#include "edge/daemon/camera_access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

const std::string kNull = "/dev/null";

UsbNode Node(std::uint16_t vendor, std::uint16_t product, const std::string& path) {
  return {.vendor_id = vendor, .product_id = product, .paths = {path}};
}

/// Holds devices that a rig's computer may have on its USB.
const std::vector<UsbNode> kConnected = {Node(0x1d27, 0x0609, "xtion"),
                                         Node(0x1d27, 0x0601, "carmine"),
                                         Node(0x0403, 0xde37, "optris"),
                                         Node(0x1e4e, 0x0100, "lepton"),
                                         Node(0x0403, 0x6001, "autopilot's serial port"),
                                         Node(0x046d, 0x0825, "a webcam"),
                                         Node(0x045e, 0x02ae, "kinect"),
                                         Node(0x045e, 0x0745, "a mouse")};

TEST(CameraAccessTest, F14TheDepthProcessHasCamerasOfOpenniAndNoOtherDevice) {
  EXPECT_THAT(AccessFor(Sensor::kDepth, {}, kConnected).value().write,
              UnorderedElementsAre(kNull, "xtion", "carmine", "kinect"));
}

TEST(CameraAccessTest, F14OfAnAddressItHasThatKindOnly) {
  SourceOptions options;
  options.mutable_depth_camera()->set_uri("1d27/0609@1/4");
  EXPECT_THAT(AccessFor(Sensor::kDepth, options, kConnected).value().write,
              UnorderedElementsAre(kNull, "xtion"));
  // A camera that we do not know, by a driver that somebody has installed.
  options.mutable_depth_camera()->set_uri("046d/0825@1/9");
  EXPECT_THAT(AccessFor(Sensor::kDepth, options, kConnected).value().write,
              UnorderedElementsAre(kNull, "a webcam"));
}

TEST(CameraAccessTest, F14TheThermalProcessHasOptrisCamerasOnly) {
  EXPECT_THAT(AccessFor(Sensor::kThermal, {}, kConnected).value().write,
              UnorderedElementsAre(kNull, "optris"));
}

TEST(CameraAccessTest, F14WhoPlaysAFileHasThatFileAndNoDevice) {
  SourceOptions options;
  options.mutable_depth_camera()->set_uri("/srv/scan.oni");
  const CameraSandbox sandbox = AccessFor(Sensor::kDepth, options, kConnected).value();
  EXPECT_THAT(sandbox.write, UnorderedElementsAre(kNull));
  EXPECT_THAT(sandbox.read, Contains("/srv/scan.oni"));
  EXPECT_THAT(sandbox.list, Not(Contains("/dev/bus/usb")));
}

TEST(CameraAccessTest, WhatTheOptionsNameIsAddedAndNothingWithoutASandbox) {
  SourceOptions options;
  auto& expert = *options.mutable_camera_sandbox()->mutable_expert();
  expert.add_read("/opt/vendor");
  expert.add_write("/dev/bus/usb/001/007");
  const CameraSandbox sandbox = AccessFor(Sensor::kDepth, options, {}).value();
  EXPECT_THAT(sandbox.read, AllOf(Contains("/opt/vendor"), IsSupersetOf({"/usr", "/lib"})));
  EXPECT_THAT(sandbox.write, UnorderedElementsAre(kNull, "/dev/bus/usb/001/007"));
  options.mutable_camera_sandbox()->set_enabled(false);
  EXPECT_FALSE(AccessFor(Sensor::kDepth, options, kConnected).has_value());
}

}  // namespace
}  // namespace isotherm
