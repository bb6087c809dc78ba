#include "edge/thermal_camera/camera_registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/check.h"
#include "common/frame/radiometric_scale.h"
#include "common/options/option_problems.h"
#include "edge/options/edge_options.pb.h"
#include "edge/thermal_camera/lepton_camera.h"
#include "edge/thermal_camera/optris_camera.h"
#include "edge/thermal_camera/p2pro_camera.h"
#include "edge/thermal_camera/p3_camera.h"
#include "edge/thermal_camera/seek_camera.h"
#include "edge/usb/usb_device.h"

namespace isotherm {
namespace {

using MakeCamera = std::unique_ptr<ThermalCamera> (*)(const DeviceDescription&,
                                                      const ThermalCameraOptions&, const Clock&);

struct KnownCamera {
  std::uint16_t vendor_id;
  std::uint16_t product_id;
  std::string_view driver;
  std::string_view product;  ///< Where the device does not name itself.
  std::string_view modes;
  MakeCamera make;
};

template <typename Camera>
std::unique_ptr<ThermalCamera> MakeOf(const DeviceDescription& device,
                                      const ThermalCameraOptions& /*options*/, const Clock& clock) {
  return std::make_unique<Camera>(device.bus_port, clock);
}

template <int kWidth, int kHeight>
std::unique_ptr<ThermalCamera> MakeP3(const DeviceDescription& device,
                                      const ThermalCameraOptions& /*options*/, const Clock& clock) {
  return std::make_unique<P3Camera>(device.bus_port, P3Layout{kWidth, kHeight}, clock);
}

template <const SeekModel& kModel>
std::unique_ptr<ThermalCamera> MakeSeek(const DeviceDescription& device,
                                        const ThermalCameraOptions& /*options*/,
                                        const Clock& clock) {
  return std::make_unique<SeekCamera>(device.bus_port, kModel, clock);
}

std::unique_ptr<ThermalCamera> MakeOptris(const DeviceDescription& device,
                                          const ThermalCameraOptions& options, const Clock& clock) {
  OptrisSettings settings{options.expert().optris_library(), options.expert().optris_config(),
                          options.expert().optris_formats(), std::nullopt};
  if (options.expert().has_optris_min_celsius() && options.expert().has_optris_max_celsius()) {
    settings.range = {options.expert().optris_min_celsius(), options.expert().optris_max_celsius()};
  }
  return std::make_unique<OptrisCamera>(device.bus_port, std::move(settings), clock);
}

// Identifiers: vendors' descriptors, as collected in docs/thermal-cameras.md.
constexpr KnownCamera kKnown[] = {
    {0x1E4E, 0x0100, LeptonCamera::kDriver, "FLIR Lepton on PureThermal", "160x120 or 80x60, 9 Hz",
     MakeOf<LeptonCamera>},
    {0x0BDA, 0x5830, P2ProCamera::kDriver, "InfiRay P2 Pro", "256x192, 25 Hz", MakeOf<P2ProCamera>},
    {0x3474, 0x45A2, P3Camera::kDriver, "Thermal Master P3", "256x192, 25 Hz", MakeP3<256, 192>},
    {0x3474, 0x45C2, P3Camera::kDriver, "Thermal Master P1", "160x120, 25 Hz", MakeP3<160, 120>},
    {0x0403, 0xDE37, OptrisCamera::kDriver, "Optris", "by the vendor's library", MakeOptris},
    {0x289D, 0x0010, SeekCamera::kDriver, "Seek Compact", "207x154, 9 Hz, counts only",
     MakeSeek<kSeekCompact>},
    {0x289D, 0x0011, SeekCamera::kDriver, "Seek CompactPro", "320x240, 9 Hz, counts only",
     MakeSeek<kSeekCompactPro>},
};

const KnownCamera* Find(std::uint16_t vendor_id, std::uint16_t product_id) {
  for (const KnownCamera& camera : kKnown) {
    if (camera.vendor_id == vendor_id && camera.product_id == product_id) return &camera;
  }
  return nullptr;
}

DeviceDescription DescribeKnown(const KnownCamera& known) {
  DeviceDescription device;
  device.driver = known.driver;
  device.product = known.product;
  device.vendor_id = known.vendor_id;
  device.product_id = known.product_id;
  device.modes = {std::string(known.modes)};
  return device;
}

DeviceDescription Describe(const UsbDeviceInfo& info) {
  // ListUsbDevices was told to list known ones only.
  DeviceDescription device = DescribeKnown(*Find(info.vendor_id, info.product_id));
  if (!info.product.empty()) device.product = info.product;
  device.serial = info.serial;
  device.bus_port = info.bus_port;
  device.problem = info.problem;
  return device;
}

/// LEPTON_UVC in the options is lepton-uvc as a driver.
std::string DriverName(ThermalDriver driver) {
  if (driver == ANY_THERMAL_CAMERA) return {};
  std::string name = ThermalDriver_Name(driver);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '_' ? '-' : static_cast<char>(std::tolower(c));
  });
  return name;
}

std::string Text(const std::vector<DeviceDescription>& devices) {
  if (devices.empty()) return "none";
  std::string text;
  for (const DeviceDescription& device : devices) {
    text += fmt::format("{}{} with serial \"{}\" at {}", text.empty() ? "" : ", ", device.driver,
                        device.serial, device.bus_port);
  }
  return text;
}

}  // namespace

Status Validate(const ThermalCameraOptions& options) {
  OptionProblems problems("source.thermal_camera");
  problems.CheckRange("expert.stall_timeout_s", options.expert().stall_timeout_s(), 0.2, 60.0);
  problems.CheckRange("expert.kelvin_per_count", options.expert().kelvin_per_count(), 0.0, 10.0);
  problems.CheckRange("expert.offset_kelvin", options.expert().offset_kelvin(), -1e5, 1e4);
  // It becomes the frames' scale where centi-kelvin would cut it off.
  const RadiometricScale own{options.expert().kelvin_per_count(), options.expert().offset_kelvin()};
  if (own.kelvin_per_count > 0.0 && own.max_celsius() > kCentikelvin.max_celsius()) {
    if (Status status = Validate(own); !status.ok())
      problems.Add("expert.kelvin_per_count", status.message());
  }
  if (options.expert().has_optris_min_celsius() != options.expert().has_optris_max_celsius()) {
    problems.Add(options.expert().has_optris_min_celsius() ? "expert.optris_max_celsius"
                                                           : "expert.optris_min_celsius",
                 "is not set: a range has two ends");
  } else if (options.expert().has_optris_min_celsius() &&
             options.expert().optris_max_celsius() <= options.expert().optris_min_celsius()) {
    problems.Add(
        "expert.optris_max_celsius",
        fmt::format("is {}, must be above optris_min_celsius, which is {}",
                    options.expert().optris_max_celsius(), options.expert().optris_min_celsius()));
  } else if (options.expert().has_optris_min_celsius()) {
    // Found out now instead of when the camera is opened.
    const auto scale =
        ScaleForRange(options.expert().optris_min_celsius(), options.expert().optris_max_celsius());
    if (!scale) problems.Add("expert.optris_max_celsius", scale.error().message());
  }
  return problems.ToStatus();
}

std::vector<DeviceDescription> SupportedThermalCameras() {
  std::vector<DeviceDescription> cameras;
  for (const KnownCamera& camera : kKnown) cameras.push_back(DescribeKnown(camera));
  return cameras;
}

Result<std::vector<DeviceDescription>> ListThermalCameras() {
  const auto known = [](std::uint16_t vendor_id, std::uint16_t product_id) {
    return Find(vendor_id, product_id) != nullptr;
  };
  const Result<std::vector<UsbDeviceInfo>> found = ListUsbDevices(known);
  if (!found) return Err(found.error());
  std::vector<DeviceDescription> devices;
  std::transform(found->begin(), found->end(), std::back_inserter(devices), Describe);
  return devices;
}

Result<DeviceDescription> ChooseThermalCamera(const std::vector<DeviceDescription>& devices,
                                              const ThermalCameraOptions& options,
                                              const std::string& pinned_serial) {
  const std::string driver = DriverName(options.driver());
  std::vector<DeviceDescription> fitting;
  for (const DeviceDescription& device : devices) {
    // The vendor's library is used only by those who ask for it.
    const bool right_driver =
        driver.empty() ? device.driver != OptrisCamera::kDriver : device.driver == driver;
    const bool fits = right_driver && (options.expert().bus_port().empty() ||
                                       device.bus_port == options.expert().bus_port());
    if (fits) fitting.push_back(device);
  }
  if (fitting.empty()) {
    return Err(Unavailable(
        fmt::format("no thermal camera{}{} is connected; connected are: {}",
                    driver.empty() ? "" : " for the driver " + driver,
                    options.expert().bus_port().empty() ? "" : " at " + options.expert().bus_port(),
                    Text(devices))));
  }
  const std::string& serial = options.serial().empty() ? pinned_serial : options.serial();
  // A camera may have no serial number, and most rigs have one thermal camera: the first one will
  // do.
  if (serial.empty()) return fitting.front();
  for (const DeviceDescription& device : fitting) {
    if (device.serial == serial) return device;
  }
  return Err(FailedPrecondition(fmt::format(
      "the thermal camera with serial \"{}\" is not connected; connected are: {}. Another camera "
      "has another calibration: connect the right one, or name the new one in "
      "source.thermal_camera.serial and calibrate the rig with it",
      serial, Text(fitting))));
}

std::unique_ptr<ThermalCamera> MakeThermalCamera(const DeviceDescription& device,
                                                 const ThermalCameraOptions& options,
                                                 const Clock& clock) {
  const KnownCamera* known = Find(device.vendor_id, device.product_id);
  CHECK(known != nullptr);
  return known->make(device, options, clock);
}

}  // namespace isotherm
