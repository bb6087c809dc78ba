#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/frame/frame.h"

namespace isotherm {

/// A camera that is connected to this computer.
struct DeviceDescription {
  Sensor sensor = Sensor::kThermal;
  std::string driver;            ///< Isotherm's driver for it, e.g. "lepton-uvc".
  std::string product;           ///< As the device calls itself.
  std::string serial;            ///< Empty: it has none.
  std::string bus_port;          ///< Where it is plugged in, e.g. "1-2.3".
  std::uint16_t vendor_id = 0;   ///< USB; 0 = not a USB device, or not known.
  std::uint16_t product_id = 0;  ///< USB.
  std::vector<std::string> modes;
  std::string problem;  ///< Why it cannot be used now; empty = it can.
};

}  // namespace isotherm
