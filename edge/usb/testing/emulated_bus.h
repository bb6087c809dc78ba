#pragma once

#include <sys/types.h>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "edge/usb/testing/emulated_device.h"

namespace isotherm {

/// A USB bus that exists only in this process and its children, so that programs with the genuine
/// libusb find and use devices that are classes of ours (umockdev; its library must be preloaded).
/// One device at a time. Bus time is real time.
///
/// Transfers are served as a kernel would: several in flight, isochronous ones one bus interval per
/// packet, cancelled ones given back, all ended when the device is unplugged. Thread-safe.
class EmulatedBus {
 public:
  /// Returns why buses cannot be emulated here; nullopt if they can.
  static std::optional<std::string> Missing();

  EmulatedBus();
  ~EmulatedBus();
  EmulatedBus(const EmulatedBus&) = delete;
  EmulatedBus& operator=(const EmulatedBus&) = delete;

  void Plug(std::shared_ptr<EmulatedDevice> device);
  void Unplug();
  bool plugged() const;

  /// The device's user will be a child of this process instead of this process itself: its requests
  /// wait until SetChild says who it is.
  void ExpectChild();
  void SetChild(pid_t child);
  /// The same if it is not always the same process: `find` is asked at each request.
  void FindChild(std::function<std::optional<pid_t>()> find);

  /// The device is plugged in here.
  static constexpr const char* kBusPort = "1-1";

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isotherm
