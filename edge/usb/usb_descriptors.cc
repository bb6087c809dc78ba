#include "edge/usb/usb_descriptors.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace isotherm {
namespace {

// Descriptor types (USB 2.0, table 9-5); 0x24 is that of classes.
constexpr std::uint8_t kConfiguration = 0x02;
constexpr std::uint8_t kInterface = 0x04;
constexpr std::uint8_t kEndpoint = 0x05;
constexpr std::uint8_t kClassSpecificInterface = 0x24;

Status TooShort(std::string_view what, std::size_t length, std::size_t needed) {
  return DataLoss(
      fmt::format("USB descriptors: {} of {} bytes instead of at least {}", what, length, needed));
}

UsbAlternate& AddAlternate(Bytes bytes, UsbConfiguration& configuration) {
  const int number = bytes[2];
  auto& interfaces = configuration.interfaces;
  auto interface = std::find_if(interfaces.begin(), interfaces.end(),
                                [number](const auto& known) { return known.number == number; });
  if (interface == interfaces.end()) {
    interface = interfaces.insert(interfaces.end(), UsbInterface{number, {}});
  }
  UsbAlternate alternate;
  alternate.number = bytes[3];
  alternate.interface_class = bytes[5];
  alternate.interface_subclass = bytes[6];
  return interface->alternates.emplace_back(std::move(alternate));
}

UsbEndpoint ReadEndpoint(Bytes bytes) {
  const int max_packet = Le16(bytes, 4);
  // Bits 12:11 are the additional transactions per microframe of high-speed endpoints.
  return {bytes[2], static_cast<UsbTransferKind>(bytes[3] & 3),
          (max_packet & 0x7FF) * (1 + (max_packet >> 11 & 3))};
}

}  // namespace

Result<UsbConfiguration> ParseConfiguration(Bytes descriptor) {
  if (descriptor.size() < 9 || descriptor[0] < 9 || descriptor[1] != kConfiguration) {
    return Err(DataLoss("USB descriptors: they do not begin with a configuration"));
  }
  const std::size_t total = Le16(descriptor, 2);
  if (total > descriptor.size()) {
    return Err(TooShort("a configuration", descriptor.size(), total));
  }
  UsbConfiguration configuration;
  configuration.value = descriptor[5];
  UsbAlternate* alternate = nullptr;
  for (std::size_t at = descriptor[0]; at < total;) {
    const std::size_t left = total - at;
    const std::size_t length = descriptor[at];
    if (left < 2 || length < 2 || length > left) {
      return Err(DataLoss(fmt::format(
          "USB descriptors: a descriptor of {} bytes at {}, where {} are left", length, at, left)));
    }
    const Bytes bytes = descriptor.subspan(at, length);
    if (bytes[1] == kInterface) {
      if (length < 9) return Err(TooShort("an interface", length, 9));
      alternate = &AddAlternate(bytes, configuration);
    } else if (bytes[1] == kEndpoint && alternate != nullptr) {
      if (length < 7) return Err(TooShort("an endpoint", length, 7));
      alternate->endpoints.push_back(ReadEndpoint(bytes));
    } else if (bytes[1] == kClassSpecificInterface && alternate != nullptr) {
      alternate->class_specific.insert(alternate->class_specific.end(), bytes.begin(), bytes.end());
    }
    at += length;
  }
  return configuration;
}

}  // namespace isotherm
