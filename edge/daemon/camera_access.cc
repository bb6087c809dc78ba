#include "edge/daemon/camera_access.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "common/base/log.h"
#include "common/options/option_problems.h"
#include "edge/camera_process/usb_nodes.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/device_description.h"
#include "edge/thermal_camera/camera_registry.h"

namespace isotherm {
namespace {

/// Libraries, and what they look up: their settings, time zone, and what the kernel and udev say of
/// devices.
constexpr const char* kSystem[] = {
    "/usr",         "/lib",           "/lib64",     "/etc/ld.so.cache", "/etc/ld.so.preload",
    "/etc/openni2", "/etc/localtime", "/proc/self", "/proc/cpuinfo",    "/dev/urandom"};
constexpr const char* kDeviceLists[] = {"/sys/bus", "/sys/class", "/sys/devices", "/run/udev/data",
                                        "/run/udev/control"};

void AddPaths(const std::string& separated, std::vector<std::string>& paths) {
  std::istringstream words(separated);
  for (std::string path; std::getline(words, path, ':');) {
    if (!path.empty()) paths.push_back(path);
  }
}

/// Adds the paths that somebody has named, so that a typing error is not silent.
void AddNamedPaths(const google::protobuf::RepeatedPtrField<std::string>& named, const char* option,
                   std::vector<std::string>& paths) {
  for (const std::string& path : named) {
    paths.push_back(path);
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) continue;
    LOG(Edge, Warning) << "source.camera_sandbox.expert." << option << ": there is no " << path
                       << "; the camera's library will not have it";
  }
}

/// One of the cameras that a driver of the other sensor is for.
bool IsThermalCamera(const UsbNode& node, const std::string& only_driver = {}) {
  const std::vector<DeviceDescription> cameras = SupportedThermalCameras();
  return std::any_of(cameras.begin(), cameras.end(), [&](const DeviceDescription& camera) {
    return camera.vendor_id == node.vendor_id && camera.product_id == node.product_id &&
           (only_driver.empty() || camera.driver == only_driver);
  });
}

/// OpenNI2 may have drivers for cameras that nothing here knows: any device that could be one, and
/// is no thermal camera.
bool MayBeDepthCamera(const UsbNode& node) {
  return !IsThermalCamera(node) && !node.has_foreign_interface();
}

void AddDevices(Sensor sensor, CameraSandbox& sandbox) {
  sandbox.read.insert(sandbox.read.end(), std::begin(kDeviceLists), std::end(kDeviceLists));
  sandbox.list.push_back("/dev/bus/usb");
  for (const UsbNode& node : ListUsbNodes()) {
    const bool is_its_own =
        sensor == Sensor::kDepth ? MayBeDepthCamera(node) : IsThermalCamera(node, "optris-sdk");
    if (!is_its_own) continue;
    sandbox.write.insert(sandbox.write.end(), node.paths.begin(), node.paths.end());
  }
}

/// A relative path would be looked for in the folder that the daemon happens to be started in.
void CheckPaths(std::string_view field,
                const google::protobuf::RepeatedPtrField<std::string>& paths,
                OptionProblems& problems) {
  for (const std::string& path : paths) {
    if (!path.empty() && path.front() == '/') continue;
    problems.Add(field, fmt::format("names \"{}\", must name a path from / on", path));
  }
}

}  // namespace

Status Validate(const CameraSandboxOptions& options) {
  OptionProblems problems("source.camera_sandbox.expert");
  CheckPaths("read", options.expert().read(), problems);
  CheckPaths("write", options.expert().write(), problems);
  return problems.ToStatus();
}

std::optional<CameraSandbox> AccessFor(Sensor sensor, const SourceOptions& options) {
  const CameraSandboxOptions& wanted = options.camera_sandbox();
  if (!wanted.expert().enabled()) return std::nullopt;
  CameraSandbox sandbox;
  sandbox.local_sockets = wanted.expert().local_sockets();
  sandbox.read.assign(std::begin(kSystem), std::end(kSystem));
  sandbox.write = {"/dev/null"};
  if (const char* libraries = std::getenv("LD_LIBRARY_PATH")) AddPaths(libraries, sandbox.read);
  AddNamedPaths(wanted.expert().read(), "read", sandbox.read);
  AddNamedPaths(wanted.expert().write(), "write", sandbox.write);
  const std::string& uri = options.depth_camera().uri();
  if (sensor == Sensor::kDepth && uri.ends_with(".oni")) {
    sandbox.read.push_back(uri);
    return sandbox;
  }
  if (sensor == Sensor::kThermal) {
    const ThermalCameraOptions& thermal = options.thermal_camera();
    for (const std::string& path :
         {thermal.expert().optris_library(), thermal.expert().optris_config(),
          thermal.expert().optris_formats()}) {
      if (path.find('/') != std::string::npos) sandbox.read.push_back(path);
    }
  }
  AddDevices(sensor, sandbox);
  return sandbox;
}

}  // namespace isotherm
