#include "edge/daemon/camera_access.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "common/base/log.h"
#include "common/options/option_problems.h"
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

bool IsOptrisCamera(const UsbNode& node) {
  const std::vector<DeviceDescription> cameras = SupportedThermalCameras();
  return std::any_of(cameras.begin(), cameras.end(), [&](const DeviceDescription& camera) {
    return camera.vendor_id == node.vendor_id && camera.product_id == node.product_id &&
           camera.driver == "optris-sdk";
  });
}

/// One of the cameras that drivers of OpenNI2 are for.
bool IsKnownDepthCamera(const UsbNode& node) {
  constexpr std::uint16_t kPrimeSense = 0x1d27;  // Also in cameras of ASUS and Occipital.
  constexpr std::uint16_t kOrbbec = 0x2bc5;
  constexpr std::uint16_t kMicrosoft = 0x045e;
  constexpr std::uint16_t kKinect = 0x02ae;
  constexpr std::uint16_t kKinectForWindows = 0x02bf;
  if (node.vendor_id == kMicrosoft)
    return node.product_id == kKinect || node.product_id == kKinectForWindows;
  return node.vendor_id == kPrimeSense || node.vendor_id == kOrbbec;
}

/// A kind of device, as OpenNI2's addresses begin: "1d27/0609@1/4".
struct DeviceKind {
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
};
std::optional<DeviceKind> KindIn(const std::string& uri) {
  unsigned vendor = 0;
  unsigned product = 0;
  if (std::sscanf(uri.c_str(), "%4x/%4x@", &vendor, &product) != 2) return std::nullopt;
  return DeviceKind{static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)};
}

/// Adds the nodes of the cameras that may be the sensor's.
void AddDevices(Sensor sensor, const std::string& uri, std::span<const UsbNode> connected,
                CameraSandbox& sandbox) {
  sandbox.read.insert(sandbox.read.end(), std::begin(kDeviceLists), std::end(kDeviceLists));
  sandbox.list.push_back("/dev/bus/usb");
  const std::optional<DeviceKind> wanted = KindIn(uri);
  for (const UsbNode& node : connected) {
    bool is_its_own = sensor == Sensor::kDepth ? IsKnownDepthCamera(node) : IsOptrisCamera(node);
    if (sensor == Sensor::kDepth && wanted)
      is_its_own = node.vendor_id == wanted->vendor_id && node.product_id == wanted->product_id;
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

std::optional<CameraSandbox> AccessFor(Sensor sensor, const SourceOptions& options,
                                       std::span<const UsbNode> connected) {
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
  AddDevices(sensor, uri, connected, sandbox);
  return sandbox;
}

}  // namespace isotherm
