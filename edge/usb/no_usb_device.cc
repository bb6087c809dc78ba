// The USB device of builds without libusb: there is none.
#include "edge/usb/usb_device.h"

namespace isotherm {
namespace {

Status NoUsb() {
  return Unavailable(
      "this build has no USB (libusb was missing, or ISOTHERM_WITH_USB_THERMAL is off)");
}

}  // namespace

class UsbDevice::Impl {
 public:
  UsbDeviceInfo info;
  UsbConfiguration configuration;
  const Clock& clock;
};

Result<std::vector<UsbDeviceInfo>> ListUsbDevices(const UsbFilter&) { return Err(NoUsb()); }
Result<std::unique_ptr<UsbDevice>> UsbDevice::Open(const std::string&, const Clock&) {
  return Err(NoUsb());
}
UsbDevice::~UsbDevice() = default;
const UsbDeviceInfo& UsbDevice::info() const { return impl_->info; }
const UsbConfiguration& UsbDevice::configuration() const { return impl_->configuration; }
const Clock& UsbDevice::clock() const { return impl_->clock; }
Nanoseconds UsbDevice::bus_interval() const { return Nanoseconds(125'000); }
Status UsbDevice::Claim(int) { return NoUsb(); }
void UsbDevice::Release(int) {}
Status UsbDevice::SetAlternate(int, int) { return NoUsb(); }
Status UsbDevice::ControlOut(const UsbControl&, Bytes) { return NoUsb(); }
Result<std::vector<std::uint8_t>> UsbDevice::ControlIn(const UsbControl&, std::size_t) {
  return Err(NoUsb());
}
Result<std::vector<std::uint8_t>> UsbDevice::BulkIn(std::uint8_t, std::size_t, Nanoseconds) {
  return Err(NoUsb());
}
Status UsbDevice::ClearHalt(std::uint8_t) { return NoUsb(); }
Status UsbDevice::StartStream(const UsbStreamPlan&, PacketSink) { return NoUsb(); }
bool UsbDevice::streaming() const { return false; }
Status UsbDevice::Pump(Nanoseconds) { return NoUsb(); }
void UsbDevice::StopStream() {}

}  // namespace isotherm
