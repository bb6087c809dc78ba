#include "edge/usb/uvc_descriptors.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace isotherm {
namespace {

// Interface class and subclasses (UVC 1.5, tables ).
constexpr std::uint8_t kVideoClass = 0x0E;
constexpr std::uint8_t kVideoControl = 1;
constexpr std::uint8_t kVideoStreaming = 2;
// Subtypes of class-specific descriptors (UVC 1.5, tables ).
constexpr std::uint8_t kControlHeader = 0x01;
constexpr std::uint8_t kExtensionUnit = 0x06;
constexpr std::uint8_t kFormatUncompressed = 0x04;
constexpr std::uint8_t kFrameUncompressed = 0x05;

UvcGuid GuidAt(Bytes bytes, std::size_t offset) {
  UvcGuid guid;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), guid.size(), guid.begin());
  return guid;
}

/// Calls `read` for each descriptor in `chain`; ParseConfiguration has checked the lengths.
Status ForEach(Bytes chain, const std::function<Status(std::uint8_t subtype, Bytes)>& read) {
  for (std::size_t at = 0; at < chain.size(); at += chain[at]) {
    const Bytes bytes = chain.subspan(at, chain[at]);
    if (bytes.size() < 3) return DataLoss("UVC descriptors: one without subtype");
    ISOTHERM_RETURN_IF_ERROR(read(bytes[2], bytes));
  }
  return OkStatus();
}

Status NeedLength(std::string_view what, Bytes bytes, std::size_t needed) {
  if (bytes.size() >= needed) return OkStatus();
  return DataLoss(fmt::format("UVC descriptors: {} of {} bytes instead of at least {}", what,
                              bytes.size(), needed));
}

Status ReadControl(Bytes chain, UvcFunction& function) {
  return ForEach(chain, [&function](std::uint8_t subtype, Bytes bytes) {
    if (subtype == kControlHeader) {
      ISOTHERM_RETURN_IF_ERROR(NeedLength("a control header", bytes, 12));
      function.version = Le16(bytes, 3);
      function.clock_hz = Le32(bytes, 7);
    } else if (subtype == kExtensionUnit) {
      ISOTHERM_RETURN_IF_ERROR(NeedLength("an extension unit", bytes, 20));
      function.units.push_back({bytes[3], GuidAt(bytes, 4)});
    }
    return OkStatus();
  });
}

Status ReadStreaming(Bytes chain, UvcFunction& function) {
  bool in_uncompressed = false;
  return ForEach(chain, [&](std::uint8_t subtype, Bytes bytes) {
    if (subtype == kFormatUncompressed) {
      ISOTHERM_RETURN_IF_ERROR(NeedLength("a format", bytes, 22));
      function.formats.push_back({bytes[3], GuidAt(bytes, 5), bytes[21], {}});
      in_uncompressed = true;
    } else if (subtype == kFrameUncompressed && in_uncompressed) {
      ISOTHERM_RETURN_IF_ERROR(NeedLength("a frame size", bytes, 26));
      // Frame descriptors follow the format that they belong to.
      function.formats.back().frames.push_back(
          {bytes[3], Le16(bytes, 5), Le16(bytes, 7), Le32(bytes, 21)});
    }
    return OkStatus();
  });
}

void ReadAlternates(const UsbInterface& interface, UvcFunction& function) {
  for (const UsbAlternate& alternate : interface.alternates) {
    for (const UsbEndpoint& endpoint : alternate.endpoints) {
      const bool streams =
          endpoint.kind == UsbTransferKind::kIsochronous || endpoint.kind == UsbTransferKind::kBulk;
      // Alternate 0 of an isochronous camera reserves nothing and has no endpoint, or one of zero
      // bytes.
      if (endpoint.is_in() && streams && endpoint.packet_bytes > 0) {
        function.alternates.push_back({alternate.number, endpoint});
      }
    }
  }
}

const UsbInterface* FindVideo(const UsbConfiguration& configuration, std::uint8_t subclass) {
  for (const UsbInterface& interface : configuration.interfaces) {
    // All alternates of an interface have one class; only the first has class-specific descriptors.
    const UsbAlternate& first = interface.alternates.front();
    if (first.interface_class == kVideoClass && first.interface_subclass == subclass) {
      return &interface;
    }
  }
  return nullptr;
}

}  // namespace

std::string_view UvcFormat::four_characters() const {
  return {reinterpret_cast<const char*>(guid.data()), 4};
}

std::optional<std::uint8_t> UvcFunction::UnitWithGuid(const UvcGuid& guid) const {
  for (const UvcUnit& unit : units) {
    if (unit.guid == guid) return unit.id;
  }
  return std::nullopt;
}

Result<UvcFunction> ParseUvc(const UsbConfiguration& configuration) {
  const UsbInterface* control = FindVideo(configuration, kVideoControl);
  const UsbInterface* streaming = FindVideo(configuration, kVideoStreaming);
  if (control == nullptr || streaming == nullptr) {
    return Err(NotFound("the USB device has no video function"));
  }
  UvcFunction function;
  function.control_interface = control->number;
  function.streaming_interface = streaming->number;
  Status status = ReadControl(control->alternates.front().class_specific, function);
  if (status.ok()) status = ReadStreaming(streaming->alternates.front().class_specific, function);
  if (!status.ok()) return Err(std::move(status));
  ReadAlternates(*streaming, function);
  return function;
}

}  // namespace isotherm
