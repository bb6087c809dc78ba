#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "edge/usb/usb_descriptors.h"
#include "edge/usb/uvc_payload.h"

namespace isotherm {

/// A device on the bus, as far as it can be known.
struct UsbDeviceInfo {
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::string bus_port;  ///< Where it is plugged in, e.g. "1-2.3"; stays the same when replugged.
  /// Strings of the device; empty if it has none, or if `problem` says why they are not known.
  std::string product;
  std::string serial;
  std::string problem;
};

/// Says whether a device is of interest; it is asked before the device is opened.
using UsbFilter = std::function<bool(std::uint16_t vendor_id, std::uint16_t product_id)>;

/// The devices that `filter` takes, opened for a moment to read their strings. One that may not be
/// opened is listed with the reason. kUnavailable if USB itself does not work.
Result<std::vector<UsbDeviceInfo>> ListUsbDevices(const UsbFilter& filter);

/// Setup packet of a control transfer (USB 2.0, section 9.3).
struct UsbControl {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

/// Holds what one endpoint delivered in one bus interval (isochronous) or transfer (bulk).
struct UsbPacket {
  Bytes data;
  HostStamp stamp;    ///< When it was on the bus, as well as the computer can tell.
  bool lost = false;  ///< The bus reports an error; data may be missing.
};

/// Says how to stream from an endpoint.
struct UsbStreamPlan {
  UsbEndpoint endpoint;
  int transfers = 8;             ///< In flight together.
  int packets_per_transfer = 0;  ///< Isochronous only.
  int transfer_bytes = 0;        ///< Bulk only.
  /// Time from packet to packet on the bus (isochronous only).
  Nanoseconds packet_interval{0};
};

/// An opened USB device. Nothing waits longer than said; a device that was unplugged answers with
/// kUnavailable. Packets of a stream are handed over inside Pump and inside control transfers, by
/// the calling thread. Thread-bound.
class UsbDevice {
 public:
  using PacketSink = std::function<void(const UsbPacket&)>;

  /// Opens the device at `bus_port`. `clock` must outlive it.
  static Result<std::unique_ptr<UsbDevice>> Open(const std::string& bus_port, const Clock& clock);
  /// Stops the stream, gives interfaces back and closes.
  ~UsbDevice();
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;

  const UsbDeviceInfo& info() const;
  const UsbConfiguration& configuration() const;
  const Clock& clock() const;
  /// The interval of the bus: 125 us at high speed and above, 1 ms below.
  Nanoseconds bus_interval() const;

  /// Takes an interface from the kernel's driver; it gets it back at the end.
  Status Claim(int interface);
  /// Gives it back, which brings it to its alternate setting 0.
  void Release(int interface);
  Status SetAlternate(int interface, int alternate);
  Status ControlOut(const UsbControl& control, Bytes data);
  /// Reads at most `size` bytes.
  Result<std::vector<std::uint8_t>> ControlIn(const UsbControl& control, std::size_t size);
  /// One bulk transfer: what has come when it is full, when a short packet has ended it, or when
  /// `timeout` has passed; empty if that is nothing. What comes later waits in the device.
  Result<std::vector<std::uint8_t>> BulkIn(std::uint8_t endpoint, std::size_t size,
                                           Nanoseconds timeout);

  /// Brings an endpoint back to work, and tells bulk cameras that their stream has ended.
  Status ClearHalt(std::uint8_t endpoint);

  Status StartStream(const UsbStreamPlan& plan, PacketSink sink);
  bool streaming() const;
  /// Handles what has happened, waiting at most `timeout` for something. kUnavailable if the device
  /// is gone, kIoError if the stream has stopped.
  Status Pump(Nanoseconds timeout);
  /// Cancels all transfers and waits until each has come back, at most half a second: the memory of
  /// those that have not is given up. Idempotent.
  void StopStream();

 private:
  class Impl;
  explicit UsbDevice(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace isotherm
