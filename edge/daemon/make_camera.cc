#include "edge/daemon/make_camera.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/options/option_problems.h"
#include "common/options/text_proto.h"
#include "edge/camera_process/camera_process.h"
#include "edge/camera_process/usb_nodes.h"
#include "edge/daemon/camera_access.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/device_description.h"
#include "edge/thermal_camera/camera_registry.h"
#include "edge/thermal_camera/thermal_camera_source.h"
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

/// Returns what one could connect.
std::string SupportedText() {
  std::string text = "  none; there are drivers for\n";
  for (const DeviceDescription& camera : SupportedThermalCameras()) {
    text += fmt::format("    {:<11} {} (USB {:04x}:{:04x})\n", camera.driver, camera.product,
                        camera.vendor_id, camera.product_id);
  }
  return text;
}

std::string ToText(const Result<std::vector<DeviceDescription>>& devices,
                   const std::string& none = "  none\n") {
  if (!devices) return fmt::format("  {}\n", devices.error().message());
  if (devices->empty()) return none;
  std::string text;
  for (const DeviceDescription& device : *devices) text += ToText(device);
  return text;
}

}  // namespace

Status Validate(const DepthCameraOptions& options) {
  OptionProblems problems("source.depth_camera.expert");
  const DepthCameraExpertOptions& expert = options.expert();
  problems.CheckRange("width", expert.width(), 16, 4096);
  problems.CheckRange("height", expert.height(), 16, 4096);
  problems.CheckRange("rate_hz", expert.rate_hz(), 1, 240);
  problems.CheckRange("stall_timeout_s", expert.stall_timeout_s(), 0.2, 60.0);
  return problems.ToStatus();
}

Result<std::unique_ptr<FrameSource>> MakeCamera(Sensor sensor, const SourceOptions& options,
                                                const Clock& clock) {
  if (sensor == Sensor::kDepth) return MakeDepthCamera(options, clock);
  return MakeThermalCameraSource(options.thermal_camera(), clock);
}

bool RunsInOwnProcess(Sensor sensor, const SourceOptions& options) {
  if (sensor == Sensor::kThermal) {
    // The other drivers are ours.
    return ThermalDriver_Name(options.thermal_camera().driver()) == "OPTRIS_SDK";
  }
  return options.depth_camera().expert().own_process();
}

std::unique_ptr<FrameSource> MakeCameraProcess(Sensor sensor, const SourceOptions& options,
                                               const Clock& clock, std::stop_token stop) {
  const bool is_depth = sensor == Sensor::kDepth;
  CameraProcess::Settings settings;
  settings.name = is_depth ? "depth camera" : "thermal camera";
  settings.program = "/proc/self/exe";
  settings.arguments = {"--camera-process", is_depth ? "depth" : "thermal", "--camera-options",
                        ToTextProto(options)};
  settings.stop = std::move(stop);
  return std::make_unique<CameraProcess>(std::move(settings), clock);
}

int RunCameraProcess(const std::string& sensor_name, const std::string& source_options,
                     const Clock& clock) {
  SourceOptions options;
  // The parent checked these options; they are parsed again because they came through a command
  // line.
  Status status = ParseTextProto(source_options, "--camera-options", options);
  const Sensor sensor = sensor_name == "depth" ? Sensor::kDepth : Sensor::kThermal;
  if (status.ok()) {
    Result<std::unique_ptr<FrameSource>> camera = MakeCamera(sensor, options, clock);
    if (camera) {
      const bool is_file = options.depth_camera().uri().ends_with(".oni");
      return ServeCamera(**camera, clock,
                         {.sandbox = AccessFor(sensor, options, ListUsbNodes()),
                          .waits = sensor == Sensor::kDepth && is_file && options.rate() == 0.0});
    }
    status = camera.error();
  }
  LOG(Edge, Error) << status.message();
  return ExitCode(status);
}

std::string ListCameras() {
  return "depth cameras:\n" + ToText(ListDepthCameras()) + "thermal cameras:\n" +
         ToText(ListThermalCameras(), SupportedText());
}

}  // namespace isotherm
