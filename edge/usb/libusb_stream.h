#pragma once

#include <memory>
#include <string>
#include <vector>

#include "edge/usb/usb_device.h"

struct libusb_context;
struct libusb_device_handle;
struct libusb_transfer;

namespace isotherm {

/// Keeps several transfers of one endpoint in flight and hands over what they bring. Callbacks run
/// wherever libusb's events are handled. May only be destroyed when Stop has said that nothing is
/// in flight any more. Thread-bound.
class LibusbStream {
 public:
  /// Says whether data still comes. kGone: the device was unplugged.
  enum class State { kRunning, kGone, kFailed };

  /// All must outlive it.
  LibusbStream(libusb_context* context, libusb_device_handle* handle, const UsbStreamPlan& plan,
               const Clock& clock, UsbDevice::PacketSink sink);
  ~LibusbStream();
  LibusbStream(const LibusbStream&) = delete;
  LibusbStream& operator=(const LibusbStream&) = delete;

  /// 0 or libusb's error code.
  int Start();
  /// Cancels what is in flight and waits until it has come back, for a bounded time. False: some is
  /// still in flight, and the kernel may write into its buffers at any time; this stream, the
  /// device's handle and the context must stay for good. Nothing is handed over any more.
  bool Stop();
  State state() const { return state_; }
  const std::string& failure() const { return failure_; }

  /// For libusb.
  void OnDone(libusb_transfer* transfer);

 private:
  struct Transfer;
  int Submit(Transfer& transfer);
  void HandOverIsochronous(const libusb_transfer& transfer);
  void HandOverBulk(const libusb_transfer& transfer);
  void Fail(State state, std::string reason);
  void CancelAll();

  libusb_context* const context_;
  libusb_device_handle* const handle_;
  const UsbStreamPlan plan_;
  const Clock& clock_;
  const UsbDevice::PacketSink sink_;
  std::vector<std::unique_ptr<Transfer>> transfers_;
  int in_flight_ = 0;
  int errors_in_a_row_ = 0;
  bool stopping_ = false;
  State state_ = State::kRunning;
  std::string failure_;
};

}  // namespace isotherm
