#pragma once

#include <cstdint>
#include <vector>

#include "common/base/status.h"
#include "edge/usb/bytes.h"

namespace isotherm {

/// Names the transfer types with their codes in bmAttributes.
enum class UsbTransferKind : std::uint8_t {
  kControl = 0,
  kIsochronous = 1,
  kBulk = 2,
  kInterrupt = 3
};

/// Describes an endpoint of a device.
struct UsbEndpoint {
  std::uint8_t address = 0;  ///< Bit 7: towards the host.
  UsbTransferKind kind = UsbTransferKind::kBulk;
  int packet_bytes =
      0;  ///< Most bytes in one bus interval; high-speed multiples are multiplied in.

  bool is_in() const { return (address & 0x80) != 0; }
};

/// Describes one alternate setting of an interface; they differ in the bandwidth that they reserve.
struct UsbAlternate {
  int number = 0;
  std::uint8_t interface_class = 0;
  std::uint8_t interface_subclass = 0;
  std::vector<UsbEndpoint> endpoints;
  /// Class-specific descriptors of the interface (type 0x24), one after the other.
  std::vector<std::uint8_t> class_specific;
};

/// Describes an interface with all its alternate settings.
struct UsbInterface {
  int number = 0;
  std::vector<UsbAlternate> alternates;
};

/// Describes a device's configuration.
struct UsbConfiguration {
  int value = 0;
  std::vector<UsbInterface> interfaces;
};

/// Reads a configuration descriptor with all that follows it (USB 2.0, section 9.6). kDataLoss if
/// lengths do not fit together; unknown descriptors are skipped.
Result<UsbConfiguration> ParseConfiguration(Bytes descriptor);

}  // namespace isotherm
