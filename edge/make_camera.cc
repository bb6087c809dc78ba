#include "edge/make_camera.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "edge/edge_options.pb.h"
#include "edge/source/device_description.h"
#if ISOTHERM_WITH_OPENNI
#include "edge/openni/openni_depth_source.h"
#include "edge/openni/openni_list.h"
#endif

namespace isotherm {
namespace {

#if ISOTHERM_WITH_OPENNI

Result<std::unique_ptr<FrameSource>> MakeDepthCamera(const SourceOptions& options,
                                                     const Clock& clock) {
  return std::make_unique<OpenniDepthSource>(options.depth_camera(), options.rate(), clock);
}

Result<std::vector<DeviceDescription>> ListDepthCameras() { return ListOpenniCameras(); }

#else

constexpr const char* kWithoutOpenni = "this program was built without OpenNI2 (libopenni2-dev)";

Result<std::unique_ptr<FrameSource>> MakeDepthCamera(const SourceOptions& /*options*/,
                                                     const Clock& /*clock*/) {
  return Err(Unavailable(kWithoutOpenni));
}

Result<std::vector<DeviceDescription>> ListDepthCameras() {
  return Err(Unavailable(kWithoutOpenni));
}

#endif

std::string ToText(const DeviceDescription& device) {
  std::string text = fmt::format("  {}, {}, serial {}, at {}\n", device.driver, device.product,
                                 device.serial.empty() ? "unknown" : device.serial,
                                 device.bus_port.empty() ? "?" : device.bus_port);
  std::string modes;
  for (const std::string& mode : device.modes) modes += (modes.empty() ? "" : ", ") + mode;
  if (!modes.empty()) text += fmt::format("    modes: {}\n", modes);
  if (!device.problem.empty()) text += fmt::format("    cannot be used: {}\n", device.problem);
  return text;
}

std::string ToText(const Result<std::vector<DeviceDescription>>& devices) {
  if (!devices) return fmt::format("  {}\n", devices.error().message());
  if (devices->empty()) return "  none\n";
  std::string text;
  for (const DeviceDescription& device : *devices) text += ToText(device);
  return text;
}

}  // namespace

Result<std::unique_ptr<FrameSource>> MakeCamera(Sensor sensor, const SourceOptions& options,
                                                const Clock& clock) {
  if (sensor == Sensor::kDepth) return MakeDepthCamera(options, clock);
  return Err(Unavailable("this program was built without thermal cameras"));
}

std::string ListCameras() { return "depth cameras:\n" + ToText(ListDepthCameras()); }

}  // namespace isotherm
