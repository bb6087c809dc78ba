#include "edge/thermal_camera/camera_registry.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace isotherm {
namespace {

using testing::HasSubstr;

TEST(CameraRegistryTest, EveryCameraWithADriverHasAUdevRule) {
  std::ostringstream rules;
  rules << std::ifstream(ISOTHERM_SOURCE_DIR "/deploy/udev/60-isotherm-thermal.rules").rdbuf();
  for (const DeviceDescription& camera : SupportedThermalCameras()) {
    EXPECT_THAT(rules.str(),
                HasSubstr(fmt::format("ATTR{{idVendor}}==\"{:04x}\", ATTR{{idProduct}}==\"{:04x}\"",
                                      camera.vendor_id, camera.product_id)))
        << camera.product;
  }
}

}  // namespace
}  // namespace isotherm
