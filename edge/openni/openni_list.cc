#include "edge/openni/openni_list.h"

#include <OpenNI.h>
#include <fmt/format.h>

#include "edge/openni/openni_settings.h"

namespace isotherm {
namespace {

DeviceDescription Look(const openni::DeviceInfo& info) {
  DeviceDescription listing;
  listing.sensor = Sensor::kDepth;
  listing.driver = "openni2";
  listing.bus_port = info.getUri();
  listing.product = fmt::format("{} {}", info.getVendor(), info.getName());
  openni::Device device;
  if (device.open(info.getUri()) != openni::STATUS_OK) {
    listing.problem = fmt::format("cannot be opened: {}", OpenniError());
    return listing;
  }
  listing.serial = SerialOf(device);
  openni::VideoStream stream;
  if (stream.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
    listing.problem = fmt::format("has no depth: {}", OpenniError());
    return listing;
  }
  listing.modes = DepthModes(stream);
  stream.destroy();
  return listing;
}

}  // namespace

Result<std::vector<DeviceDescription>> ListOpenniCameras() {
  const OpenniLibrary library;
  if (!library.status().ok()) return Err(library.status());
  openni::Array<openni::DeviceInfo> found;
  openni::OpenNI::enumerateDevices(&found);
  std::vector<DeviceDescription> listings;
  for (int i = 0; i < found.getSize(); ++i) listings.push_back(Look(found[i]));
  return listings;
}

}  // namespace isotherm
