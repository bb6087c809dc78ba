#include "edge/thermal_camera/open_uvc_camera.h"

#include <utility>

namespace isotherm {

Result<std::unique_ptr<UvcCamera>> OpenUvcCamera(const Clock& clock, ThermalCameraInfo& info) {
  Result<std::unique_ptr<UsbDevice>> device = UsbDevice::Open(info.bus_port, clock);
  if (!device) return Err(device.error());
  info.product = (*device)->info().product;
  info.serial = (*device)->info().serial;
  return UvcCamera::Make(std::move(*device));
}

RawThermalFrame BeginFrame(const UvcFrame& frame) {
  RawThermalFrame raw;
  raw.first_packet = frame.first_packet;
  raw.incomplete = frame.incomplete;
  raw.dropped_before = frame.dropped_before;
  return raw;
}

}  // namespace isotherm
