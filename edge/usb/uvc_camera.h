#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "edge/usb/usb_device.h"
#include "edge/usb/uvc_descriptors.h"
#include "edge/usb/uvc_payload.h"

namespace isotherm {

/// Says which of a camera's images to stream.
struct UvcMode {
  std::string_view four_characters;  ///< Beginning of the format's GUID, e.g. "Y16 ".
  int width = 0;
  int height = 0;
};

/// Streams one uncompressed mode of a UVC camera and gives access to its extension units
/// (UVC 1.0 to 1.5). Thread-bound.
class UvcCamera {
 public:
  /// `device` must be a camera. kNotFound if it has no video function.
  static Result<std::unique_ptr<UvcCamera>> Make(std::unique_ptr<UsbDevice> device);
  ~UvcCamera();

  /// Returns whether the camera offers `mode`.
  bool Has(const UvcMode& mode) const;
  /// Agrees on the mode with the camera and starts the stream.
  Status Start(const UvcMode& mode);
  /// The next frame, whole or incomplete; nullopt if none came within `timeout`. kUnavailable if
  /// the camera was unplugged.
  Result<std::optional<UvcFrame>> Read(Nanoseconds timeout);
  void Stop();

  /// Controls of the extension unit with `guid`: kNotFound if the camera has no such unit.
  Result<std::vector<std::uint8_t>> GetControl(const UvcGuid& guid, std::uint8_t selector,
                                               std::size_t size);
  Status SetControl(const UvcGuid& guid, std::uint8_t selector, Bytes data);

  UsbDevice& device() { return *device_; }
  const UvcFunction& function() const { return function_; }
  /// Nominal, from the negotiation; 0 before Start.
  double frame_rate_hz() const;

 private:
  UvcCamera(std::unique_ptr<UsbDevice> device, UvcFunction function);
  const UvcFormat* FindFormat(const UvcMode& mode) const;
  Status ClaimControl();
  Status Negotiate(const UvcFormat& format, const UvcFrameSize& frame);
  Result<UvcAlternate> ChooseAlternate() const;
  UsbStreamPlan PlanFor(const UvcAlternate& alternate) const;
  std::size_t MaxPayloadBytes() const;
  void Take(const UsbPacket& packet);

  const std::unique_ptr<UsbDevice> device_;
  const UvcFunction function_;
  bool claimed_ = false;
  bool started_ = false;
  std::size_t frame_bytes_ = 0;
  std::uint32_t payload_bytes_ = 0;
  std::uint32_t interval_ = 0;  ///< 100 ns.
  std::optional<UvcAssembler> assembler_;
  std::optional<UvcBulkJoiner> joiner_;  ///< Only of streams of bulk transfers.
  std::uint8_t bulk_endpoint_ = 0;
};

}  // namespace isotherm
