#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/base/log.h"
#include "common/base/mutex.h"
#include "edge/usb/libusb_stream.h"
#include "edge/usb/usb_device.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

// A camera that is busy answers within some milliseconds; beyond this it is taken for hung. Longer:
// an unplugged camera holds up the end of the program; shorter: one that is writing its flash
// fails. Not tuned.
constexpr milliseconds kControlTimeout{500};

struct ContextDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ContextDeleter>;

struct HandleDeleter {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using Handle = std::unique_ptr<libusb_device_handle, HandleDeleter>;

Status FromLibusb(int code, const std::string& what) {
  const std::string text = fmt::format("{}: {}", what, libusb_strerror(code));
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
      return Unavailable(what + ": the device is gone");
    case LIBUSB_ERROR_ACCESS:
      return FailedPrecondition(
          text +
          "; may this user open the device? install deploy/udev/60-isotherm-thermal.rules "
          "and replug it");
    case LIBUSB_ERROR_BUSY:
      return FailedPrecondition(text + "; another program has it open");
    case LIBUSB_ERROR_PIPE:
      return IoError(what + ": the device refuses (stall)");
    default:
      return IoError(text);
  }
}

std::string BusPort(libusb_device* device) {
  std::array<std::uint8_t, 8> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), ports.size());
  std::string text = std::to_string(libusb_get_bus_number(device));
  // Devices at the root of some controllers have no ports; the address names them until they are
  // replugged.
  if (count <= 0) return fmt::format("{}-a{}", text, libusb_get_device_address(device));
  for (int i = 0; i < count; ++i) {
    text += (i == 0 ? '-' : '.') + std::to_string(ports[static_cast<std::size_t>(i)]);
  }
  return text;
}

std::string ReadString(libusb_device_handle* handle, std::uint8_t index) {
  if (index == 0) return {};
  std::array<unsigned char, 128> text{};
  const int length =
      libusb_get_string_descriptor_ascii(handle, index, text.data(), static_cast<int>(text.size()));
  return length > 0 ? std::string(text.begin(), text.begin() + length) : std::string();
}

/// Opens `device` and fills `info`; the reason in `info.problem` if it cannot be opened.
Handle OpenAndDescribe(libusb_device* device, UsbDeviceInfo& info, int& code) {
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  info.vendor_id = descriptor.idVendor;
  info.product_id = descriptor.idProduct;
  info.bus_port = BusPort(device);
  libusb_device_handle* raw = nullptr;
  code = libusb_open(device, &raw);
  Handle handle(raw);
  if (code != 0) {
    info.problem = FromLibusb(code, "opening it").message();
    return nullptr;
  }
  info.product = ReadString(handle.get(), descriptor.iProduct);
  info.serial = ReadString(handle.get(), descriptor.iSerialNumber);
  return handle;
}

Result<Context> MakeContext() {
  libusb_context* raw = nullptr;
  if (const int code = libusb_init(&raw); code != 0) {
    return Err(Unavailable(fmt::format("USB does not work here: {}", libusb_strerror(code))));
  }
  return Context(raw);
}

/// The devices on the bus, given back at the end.
class DeviceList {
 public:
  explicit DeviceList(libusb_context* context)
      : count_(libusb_get_device_list(context, &devices_)) {}
  ~DeviceList() {
    if (devices_ != nullptr) libusb_free_device_list(devices_, 1);
  }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;

  libusb_device** begin() const { return devices_; }
  libusb_device** end() const { return devices_ + std::max<ssize_t>(count_, 0); }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t count_ = 0;
};

/// The first configuration's descriptors with all class-specific ones, as the device sends them.
Result<UsbConfiguration> ReadConfiguration(libusb_device_handle* handle) {
  std::vector<std::uint8_t> bytes(9);
  // The header says how long the whole is.
  for (int pass = 0; pass < 2; ++pass) {
    const int size = static_cast<int>(bytes.size());
    const int got =
        libusb_get_descriptor(handle, LIBUSB_DT_CONFIG, 0, bytes.data(), static_cast<int>(size));
    if (got < 0) return Err(FromLibusb(got, "reading its configuration"));
    bytes.resize(static_cast<std::size_t>(got));
    if (got < 9) return Err(DataLoss("the USB configuration is shorter than its header"));
    if (pass == 0) bytes.resize(std::max<std::size_t>(Le16(bytes, 2), 9));
  }
  return ParseConfiguration(bytes);
}

}  // namespace

Result<std::vector<UsbDeviceInfo>> ListUsbDevices(const UsbFilter& filter) {
  const Result<Context> context = MakeContext();
  if (!context) return Err(context.error());
  std::vector<UsbDeviceInfo> found;
  for (libusb_device* device : DeviceList(context->get())) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(device, &descriptor) != 0) continue;
    if (!filter(descriptor.idVendor, descriptor.idProduct)) continue;
    int code = 0;
    static_cast<void>(OpenAndDescribe(device, found.emplace_back(), code));
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.bus_port < b.bus_port; });
  return found;
}

class UsbDevice::Impl {
 public:
  Impl(Context context, const Clock& clock) : context_(std::move(context)), clock_(clock) {}
  ~Impl() {
    StopStream();
    while (!claimed_.empty()) Release(claimed_.back());
    if (!unsound_) return;
    static_cast<void>(handle_.release());
    static_cast<void>(context_.release());
  }

  Status Open(const std::string& bus_port) {
    for (libusb_device* device : DeviceList(context_.get())) {
      if (BusPort(device) != bus_port) continue;
      int code = 0;
      handle_ = OpenAndDescribe(device, info_, code);
      if (!handle_) return FromLibusb(code, "USB device " + bus_port);
      high_speed_ = libusb_get_device_speed(device) >= LIBUSB_SPEED_HIGH;
      // Linux's video driver takes cameras of this kind; libusb gives them back to it at the end.
      libusb_set_auto_detach_kernel_driver(handle_.get(), 1);
      Result<UsbConfiguration> configuration = ReadConfiguration(handle_.get());
      if (!configuration) return configuration.error().WithContext("USB device " + bus_port);
      configuration_ = std::move(*configuration);
      return OkStatus();
    }
    return Unavailable("no USB device at " + bus_port);
  }

  Status Check(int code, const std::string& what) const {
    if (code >= 0) return OkStatus();
    return FromLibusb(code, fmt::format("USB device {}, {}", info_.bus_port, what));
  }

  Status Claim(int interface) {
    const Status claimed = Check(libusb_claim_interface(handle_.get(), interface),
                                 fmt::format("claiming interface {}", interface));
    if (claimed.ok()) claimed_.push_back(interface);
    return claimed;
  }

  void Release(int interface) {
    std::erase(claimed_, interface);
    libusb_release_interface(handle_.get(), interface);
  }

  void StopStream() { Discard(std::move(stream_)); }

  /// Destroys it, unless the kernel still has some of its memory.
  void Discard(std::unique_ptr<LibusbStream> stream) {
    if (!stream || stream->Stop()) return;
    LOG(Usb, Error) << "USB device " << info_.bus_port
                    << ": cancelled transfers did not come back; their memory is given up";
    // Kept for good, and where a leak checker finds it.
    static Mutex mutex;
    static auto* const given_up GUARDED_BY(mutex) =
        new std::vector<std::unique_ptr<LibusbStream>>();
    const MutexLock lock(mutex);
    given_up->push_back(std::move(stream));
    unsound_ = true;
  }

  Status SetAlternate(int interface, int alternate) {
    const int code = libusb_set_interface_alt_setting(handle_.get(), interface, alternate);
    if (code == LIBUSB_ERROR_NO_DEVICE) unsound_ = true;
    return Check(
        code, fmt::format("choosing alternate setting {} of interface {}", alternate, interface));
  }

  // Named as members of UsbDevice, whose they are.
  // NOLINTBEGIN(readability-identifier-naming)
  Context context_;
  const Clock& clock_;
  Handle handle_;
  /// The device and libusb's context are never closed: transfers are still in flight, or libusb
  /// 1.0.26 has unlocked a mutex that it had not locked, as it does if an alternate setting is
  /// asked of a device that was just unplugged, and would abort.
  bool unsound_ = false;
  UsbDeviceInfo info_;
  UsbConfiguration configuration_;
  bool high_speed_ = false;
  std::vector<int> claimed_;
  std::unique_ptr<LibusbStream> stream_;
  // NOLINTEND(readability-identifier-naming)
};

Result<std::unique_ptr<UsbDevice>> UsbDevice::Open(const std::string& bus_port,
                                                   const Clock& clock) {
  Result<Context> context = MakeContext();
  if (!context) return Err(context.error());
  auto impl = std::make_unique<Impl>(std::move(*context), clock);
  if (Status opened = impl->Open(bus_port); !opened.ok()) return Err(std::move(opened));
  return std::unique_ptr<UsbDevice>(new UsbDevice(std::move(impl)));
}

UsbDevice::UsbDevice(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UsbDevice::~UsbDevice() = default;

const UsbDeviceInfo& UsbDevice::info() const { return impl_->info_; }
const UsbConfiguration& UsbDevice::configuration() const { return impl_->configuration_; }
const Clock& UsbDevice::clock() const { return impl_->clock_; }
Nanoseconds UsbDevice::bus_interval() const {
  return impl_->high_speed_ ? Nanoseconds(125'000) : Nanoseconds(1'000'000);
}

Status UsbDevice::Claim(int interface) { return impl_->Claim(interface); }

void UsbDevice::Release(int interface) { impl_->Release(interface); }
Status UsbDevice::SetAlternate(int interface, int alternate) {
  return impl_->SetAlternate(interface, alternate);
}

Status UsbDevice::ControlOut(const UsbControl& control, Bytes data) {
  std::vector<std::uint8_t> bytes(data.begin(), data.end());
  const int sent = libusb_control_transfer(
      impl_->handle_.get(), control.request_type, control.request, control.value, control.index,
      bytes.data(), static_cast<std::uint16_t>(bytes.size()), kControlTimeout.count());
  if (sent >= 0 && static_cast<std::size_t>(sent) != bytes.size()) {
    return IoError(fmt::format("USB device {} took {} of {} bytes of a control request",
                               impl_->info_.bus_port, sent, bytes.size()));
  }
  return impl_->Check(
      sent, fmt::format("control request 0x{:02x} to 0x{:04x}", control.request, control.index));
}

Result<std::vector<std::uint8_t>> UsbDevice::ControlIn(const UsbControl& control,
                                                       std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  const int got = libusb_control_transfer(
      impl_->handle_.get(), control.request_type, control.request, control.value, control.index,
      bytes.data(), static_cast<std::uint16_t>(size), kControlTimeout.count());
  if (Status ok = impl_->Check(
          got, fmt::format("control request 0x{:02x} to 0x{:04x}", control.request, control.index));
      !ok.ok()) {
    return Err(std::move(ok));
  }
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

Result<std::vector<std::uint8_t>> UsbDevice::BulkIn(std::uint8_t endpoint, std::size_t size,
                                                    Nanoseconds timeout) {
  std::vector<std::uint8_t> bytes(size);
  int got = 0;
  const auto wait = std::max(std::chrono::duration_cast<milliseconds>(timeout), milliseconds(1));
  const int code =
      libusb_bulk_transfer(impl_->handle_.get(), endpoint, bytes.data(), static_cast<int>(size),
                           &got, static_cast<unsigned>(wait.count()));
  // What came before the timeout is delivered: bulk streams pause between frames.
  const bool timed_out = code == LIBUSB_ERROR_TIMEOUT;
  if (Status ok = impl_->Check(timed_out ? 0 : code, "a bulk transfer"); !ok.ok()) {
    return Err(std::move(ok));
  }
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

Status UsbDevice::ClearHalt(std::uint8_t endpoint) {
  return impl_->Check(libusb_clear_halt(impl_->handle_.get(), endpoint),
                      fmt::format("clearing endpoint 0x{:02x}", endpoint));
}

Status UsbDevice::StartStream(const UsbStreamPlan& plan, PacketSink sink) {
  StopStream();
  auto stream = std::make_unique<LibusbStream>(impl_->context_.get(), impl_->handle_.get(), plan,
                                               impl_->clock_, std::move(sink));
  // Some of its transfers may be under way already, so it cannot simply be destroyed.
  if (const int code = stream->Start(); code != 0) {
    impl_->Discard(std::move(stream));
    return impl_->Check(code, "starting its stream");
  }
  impl_->stream_ = std::move(stream);
  return OkStatus();
}

bool UsbDevice::streaming() const { return impl_->stream_ != nullptr; }

Status UsbDevice::Pump(Nanoseconds timeout) {
  const auto microseconds = std::chrono::duration_cast<std::chrono::microseconds>(timeout).count();
  timeval wait{microseconds / 1'000'000, microseconds % 1'000'000};
  const int code = libusb_handle_events_timeout_completed(impl_->context_.get(), &wait, nullptr);
  if (code != 0 && code != LIBUSB_ERROR_INTERRUPTED) {
    return impl_->Check(code, "waiting for its data");
  }
  if (impl_->stream_ == nullptr) return OkStatus();
  switch (impl_->stream_->state()) {
    case LibusbStream::State::kRunning:
      return OkStatus();
    case LibusbStream::State::kGone:
      return Unavailable(fmt::format("USB device {} ({}) was unplugged", impl_->info_.bus_port,
                                     impl_->info_.product));
    case LibusbStream::State::kFailed:
      break;
  }
  return IoError(fmt::format("USB device {} ({}): its stream has stopped: {}",
                             impl_->info_.bus_port, impl_->info_.product,
                             impl_->stream_->failure()));
}

void UsbDevice::StopStream() { impl_->StopStream(); }

}  // namespace isotherm
