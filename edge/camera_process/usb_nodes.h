#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isotherm {

/// A device on the USB as the kernel's files describe it.
struct UsbNode {
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  /// The files to use it by: its own below /dev/bus/usb, and those of the kernel's video driver.
  std::vector<std::string> paths;
};

/// Returns what is connected. `devices`: the kernel's folder of USB devices.
std::vector<UsbNode> ListUsbNodes(const std::filesystem::path& devices = "/sys/bus/usb/devices");

}  // namespace isotherm
