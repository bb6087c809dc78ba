#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "edge/usb/usb_descriptors.h"

namespace isotherm {

using UvcGuid = std::array<std::uint8_t, 16>;

/// An extension unit: vendor controls behind a GUID; its id may differ between devices.
struct UvcUnit {
  std::uint8_t id = 0;
  UvcGuid guid{};
};

/// Holds an image size of a format.
struct UvcFrameSize {
  std::uint8_t index = 0;
  int width = 0;
  int height = 0;
  std::uint32_t default_interval = 0;  ///< 100 ns.
};

/// An uncompressed format; its GUID begins with the four characters, e.g. "Y16 ".
struct UvcFormat {
  std::uint8_t index = 0;
  UvcGuid guid{};
  int bits_per_pixel = 0;
  std::vector<UvcFrameSize> frames;

  std::string_view four_characters() const;
};

/// A way to stream: the bandwidth that an alternate setting reserves.
struct UvcAlternate {
  int number = 0;
  UsbEndpoint endpoint;
};

/// The video function of a device (USB Video Class 1.0 to 1.5).
struct UvcFunction {
  int control_interface = 0;
  int version = 0x0100;        ///< Binary coded decimal.
  std::uint32_t clock_hz = 0;  ///< Rate of presentation time stamps.
  std::vector<UvcUnit> units;
  int streaming_interface = 0;
  std::vector<UvcFormat> formats;
  std::vector<UvcAlternate>
      alternates;  ///< The settings with an endpoint that streams to the host.

  /// Id of the extension unit with this GUID; nullopt if there is none.
  std::optional<std::uint8_t> UnitWithGuid(const UvcGuid& guid) const;
};

/// Finds the first video function with its first stream. kDataLoss if its descriptors are
/// malformed, kNotFound if there is none. Compressed formats are left out.
Result<UvcFunction> ParseUvc(const UsbConfiguration& configuration);

}  // namespace isotherm
