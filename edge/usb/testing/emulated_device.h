#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/time/time_types.h"
#include "edge/usb/usb_device.h"

namespace isotherm {

/// Holds what identifies an emulated device.
struct EmulatedIdentity {
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::string product;
  std::string serial;
  bool high_speed = false;
  std::vector<std::uint8_t> configuration;  ///< Configuration descriptor with all that follows it.
};

/// An isochronous packet as the bus delivers it.
struct EmulatedPacket {
  std::vector<std::uint8_t> bytes;
  bool lost = false;  ///< The bus reports an error instead.
};

/// A device as seen from the bus. All calls come one after the other. Thread-compatible.
class EmulatedDevice {
 public:
  virtual ~EmulatedDevice() = default;

  virtual EmulatedIdentity identity() const = 0;
  /// Answers a request: what the host reads (nothing if it writes), or nullopt to refuse (stall).
  /// Standard requests are answered by the bus.
  virtual std::optional<std::vector<std::uint8_t>> Control(const UsbControl& control, Bytes data,
                                                           std::size_t read_bytes) = 0;
  virtual void SetAlternate(int interface, int alternate) = 0;
  virtual void ClearHalt(std::uint8_t /*endpoint*/) {}
  /// Returns what it sends in the bus interval at `time` (from an arbitrary zero).
  virtual EmulatedPacket Isochronous(std::uint8_t endpoint, Nanoseconds time, std::size_t most) = 0;
  /// One bulk transfer; nullopt = nothing to send yet.
  virtual std::optional<std::vector<std::uint8_t>> Bulk(std::uint8_t endpoint, Nanoseconds time,
                                                        std::size_t most) = 0;
  /// False: transfers that are cancelled stay away for as long as it says so.
  virtual bool GivesBackCancelled() const { return true; }
  /// The cable came off. When it comes back, if it does.
  struct Unplugged {
    std::optional<Nanoseconds> back_after;
  };
  virtual std::optional<Unplugged> TakeUnplugged() = 0;
};

}  // namespace isotherm
