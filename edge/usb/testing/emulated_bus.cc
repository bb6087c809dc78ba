#include "edge/usb/testing/emulated_bus.h"

#include <fmt/format.h>
// Before linux/usbdevice_fs.h, which uses its macros.
#include <sys/ioctl.h>

#include <linux/usbdevice_fs.h>
#include <umockdev.h>
#include <unistd.h>
#include <cerrno>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/base/mutex.h"
#include "edge/usb/testing/emulated_requests.h"

namespace isotherm {
namespace {

using std::chrono::steady_clock;

constexpr const char* kSysPath = "/sys/devices/usb1/1-1";
// The file of an emulated device is always ready, so a client with nothing to do asks again and
// again: it gets its answer after this time, or when there is something.
constexpr Nanoseconds kLookAgainAfter = std::chrono::milliseconds(5);
constexpr Nanoseconds kAnswerNothingAfter = std::chrono::milliseconds(2);
// With nothing due, the bus looks around this often.
constexpr Nanoseconds kIdlePoll = std::chrono::milliseconds(100);
// It does not spin when something is overdue.
constexpr Nanoseconds kMinWait = std::chrono::microseconds(50);

Nanoseconds Now() { return steady_clock::now().time_since_epoch(); }

/// Ends the test program if umockdev failed.
void Expect(bool done, const GError* error) {
  if (done) return;
  LOG(Usb, Error) << "umockdev: " << (error != nullptr ? error->message : "failed");
  CHECK(done);
}

std::vector<std::uint8_t> DeviceDescriptor(const EmulatedIdentity& identity) {
  std::vector<std::uint8_t> bytes = {18, 1, 0x00, 0x02, 0xEF, 0x02, 0x01, 64, 0,
                                     0,  0, 0,    0,    1,    0,    1,    2,  1};
  PutLe16(bytes, 8, identity.vendor_id);
  PutLe16(bytes, 10, identity.product_id);
  if (identity.serial.empty()) bytes[16] = 0;
  return bytes;
}

/// The description that umockdev reads, without the descriptors (it takes no long lines).
std::string Describe(const EmulatedIdentity& identity, int number, const std::string& node) {
  return fmt::format(
      "P: /devices/usb1/1-1\nN: {0}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
      "E: DEVNAME=/dev/{0}\nE: BUSNUM=001\nE: DEVNUM={1:03}\nE: MAJOR=189\nE: MINOR={2}\n"
      "A: busnum=1\nA: devnum={1}\nA: bConfigurationValue=1\nA: bNumConfigurations=1\n"
      "A: speed={3}\nA: idVendor={4:04x}\nA: idProduct={5:04x}\n",
      node, number, number - 1, identity.high_speed ? 480 : 12, identity.vendor_id,
      identity.product_id);
}

std::vector<std::uint8_t> Descriptors(const EmulatedIdentity& identity) {
  std::vector<std::uint8_t> bytes = DeviceDescriptor(identity);
  bytes.insert(bytes.end(), identity.configuration.begin(), identity.configuration.end());
  return bytes;
}

}  // namespace

class EmulatedBus::Impl {
 public:
  Impl() : testbed_(umockdev_testbed_new()) {
    thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  }
  ~Impl() {
    Unplug();
    thread_.request_stop();
    thread_.join();
    g_object_unref(testbed_);
  }

  void Plug(std::shared_ptr<EmulatedDevice> device);
  void Unplug();
  bool plugged() const {
    const MutexLock lock(mutex_);
    return device_ != nullptr;
  }
  void SetChild(std::optional<pid_t> child) {
    const MutexLock lock(mutex_);
    child_ = child;
    requests_.reset();  // They were another process's.
    Poke();
  }
  void FindChild(std::function<std::optional<pid_t>()> find) {
    const MutexLock lock(mutex_);
    find_child_ = std::move(find);
  }

 private:
  static gboolean OnIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    static_cast<Impl*>(self)->Handle(client);
    return TRUE;
  }
  void Handle(UMockdevIoctlClient* client);
  /// 0 or an error number.
  int Do(unsigned long request, std::uintptr_t argument) REQUIRES(mutex_);
  int DoSmall(unsigned long request, std::uintptr_t argument) REQUIRES(mutex_);
  void AnswerReap() REQUIRES(mutex_);
  /// Wakes whoever waits.
  void Poke() REQUIRES(mutex_) {
    poked_ = true;
    changed_.notify_all();
  }
  void Run(const std::stop_token& stop);
  void UnplugIfItWants();

  UMockdevTestbed* const testbed_;
  mutable Mutex mutex_;
  Mutex plug_mutex_;  ///< Held while the device appears or disappears.
  std::condition_variable_any changed_;
  bool poked_ GUARDED_BY(mutex_) = false;
  std::optional<pid_t> child_ GUARDED_BY(mutex_) = getpid();
  std::function<std::optional<pid_t>()> find_child_ GUARDED_BY(mutex_);
  std::shared_ptr<EmulatedDevice> device_ GUARDED_BY(mutex_);
  std::unique_ptr<EmulatedRequests> requests_ GUARDED_BY(mutex_);
  UMockdevIoctlBase* handler_ GUARDED_BY(plug_mutex_) = nullptr;
  std::string node_ GUARDED_BY(mutex_);
  int number_ GUARDED_BY(plug_mutex_) = 1;
  bool gone_ GUARDED_BY(mutex_) = true;
  /// Client that waits for a finished request.
  UMockdevIoctlClient* reaping_ GUARDED_BY(mutex_) = nullptr;
  /// Where that client wants the request's address.
  std::uintptr_t reap_into_ GUARDED_BY(mutex_) = 0;
  Nanoseconds reap_until_ GUARDED_BY(mutex_){0};
  /// The last time that it was asked.
  bool found_nothing_ GUARDED_BY(mutex_) = false;
  std::shared_ptr<EmulatedDevice> comes_back_;
  std::optional<Nanoseconds> comes_back_at_;
  std::jthread thread_;
};

std::optional<std::string> EmulatedBus::Missing() {
  const char* preloaded = std::getenv("LD_PRELOAD");
  if (preloaded != nullptr &&
      std::string_view(preloaded).find("libumockdev-preload") != std::string_view::npos) {
    return std::nullopt;
  }
  return "umockdev is not preloaded: run it by ctest or with umockdev-wrapper";
}

EmulatedBus::EmulatedBus() : impl_(std::make_unique<Impl>()) {}
EmulatedBus::~EmulatedBus() = default;
void EmulatedBus::Plug(std::shared_ptr<EmulatedDevice> device) { impl_->Plug(std::move(device)); }
void EmulatedBus::Unplug() { impl_->Unplug(); }
bool EmulatedBus::plugged() const { return impl_->plugged(); }
void EmulatedBus::ExpectChild() { impl_->SetChild(std::nullopt); }
void EmulatedBus::SetChild(pid_t child) { impl_->SetChild(child); }
void EmulatedBus::FindChild(std::function<std::optional<pid_t>()> find) {
  impl_->FindChild(std::move(find));
}

void EmulatedBus::Impl::Plug(std::shared_ptr<EmulatedDevice> device) {
  const MutexLock plug_lock(plug_mutex_);
  ++number_;
  const std::string node = fmt::format("bus/usb/001/{:03}", number_);
  const EmulatedIdentity identity = device->identity();
  {
    const MutexLock lock(mutex_);
    CHECK(gone_);
    node_ = node;
    device_ = std::move(device);
    requests_.reset();
    gone_ = false;
  }
  GError* error = nullptr;
  const std::string description = Describe(identity, number_, node);
  Expect(umockdev_testbed_add_from_string(testbed_, description.c_str(), &error), error);
  std::vector<std::uint8_t> descriptors = Descriptors(identity);
  umockdev_testbed_set_attribute_binary(testbed_, kSysPath, "descriptors", descriptors.data(),
                                        static_cast<gint>(descriptors.size()));
  handler_ = umockdev_ioctl_base_new();
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&Impl::OnIoctl), this);
  Expect(umockdev_testbed_attach_ioctl(testbed_, ("/dev/" + node).c_str(), handler_, &error),
         error);
  umockdev_testbed_uevent(testbed_, kSysPath, "add");
}

void EmulatedBus::Impl::Unplug() {
  const MutexLock plug_lock(plug_mutex_);
  std::string node;
  {
    const MutexLock lock(mutex_);
    if (gone_) return;
    node = node_;
  }
  // The user's requests end last. Then it closes its USB context, and umockdev aborts if whom it
  // tells of a change closes its socket meanwhile; in Plug that may still happen to a user that
  // opens and closes contexts until the device is back.
  umockdev_testbed_uevent(testbed_, kSysPath, "remove");
  GError* error = nullptr;
  Expect(umockdev_testbed_detach_ioctl(testbed_, ("/dev/" + node).c_str(), &error), error);
  umockdev_testbed_remove_device(testbed_, kSysPath);
  {
    const MutexLock lock(mutex_);
    gone_ = true;
    if (requests_) requests_->EndAll();
    device_.reset();
    AnswerReap();
  }
  g_object_unref(std::exchange(handler_, nullptr));
}

void EmulatedBus::Impl::Handle(UMockdevIoctlClient* client) {
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  std::uintptr_t address = 0;
  __builtin_memcpy(&address, argument->data, sizeof(address));
  const unsigned long request = umockdev_ioctl_client_get_request(client);
  MutexLock lock(mutex_);
  while (find_child_) {
    const std::optional<pid_t> before = std::exchange(child_, find_child_());
    if (child_ != before) requests_.reset();
    if (child_) break;
    changed_.wait_for(lock, kLookAgainAfter);
  }
  changed_.wait(lock, [this]() REQUIRES(mutex_) { return child_.has_value(); });
  const bool replugged = umockdev_ioctl_client_get_devnode(client) != "/dev/" + node_;
  if (!replugged && (request == USBDEVFS_REAPURBNDELAY || request == USBDEVFS_REAPURB)) {
    reaping_ = UMOCKDEV_IOCTL_CLIENT(g_object_ref(client));
    reap_into_ = address;
    reap_until_ = Now() + kAnswerNothingAfter;
    AnswerReap();
    Poke();
    return;
  }
  const int error = gone_ || replugged ? ENODEV : Do(request, address);
  Poke();
  lock.unlock();
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
}

int EmulatedBus::Impl::Do(unsigned long request, std::uintptr_t argument) {
  if (!requests_) requests_ = std::make_unique<EmulatedRequests>(*device_, ClientMemory(*child_));
  switch (request) {
    case USBDEVFS_SUBMITURB:
      return requests_->Submit(argument, Now());
    case USBDEVFS_DISCARDURB:
      return requests_->Discard(argument);
    default:
      return DoSmall(request, argument);
  }
}

int EmulatedBus::Impl::DoSmall(unsigned long request, std::uintptr_t argument) {
  const ClientMemory memory(*child_);
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      // Requests of any size at once, as kernels since 3.3 take them.
      memory.Put<std::uint32_t>(argument,
                                USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM);
      return 0;
    case USBDEVFS_SETINTERFACE: {
      const auto setting = memory.Get<usbdevfs_setinterface>(argument);
      device_->SetAlternate(static_cast<int>(setting.interface),
                            static_cast<int>(setting.altsetting));
      return 0;
    }
    case USBDEVFS_RELEASEINTERFACE:
      device_->SetAlternate(static_cast<int>(memory.Get<unsigned>(argument)), 0);
      return 0;
    case USBDEVFS_CLEAR_HALT:
      device_->ClearHalt(static_cast<std::uint8_t>(memory.Get<unsigned>(argument)));
      return 0;
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RESET:
      return 0;
    case USBDEVFS_GETDRIVER:
    case USBDEVFS_IOCTL:
      return ENODATA;  // No driver of the kernel's has it.
    default:
      return ENOTTY;
  }
}

void EmulatedBus::Impl::AnswerReap() {
  if (reaping_ == nullptr) return;
  const std::optional<std::uintptr_t> finished = requests_ ? requests_->Reap() : std::nullopt;
  // The first time there is nothing it says so at once, as a kernel would: a client that finds
  // something each time it asks would never look up.
  const bool at_once = !std::exchange(found_nothing_, !finished);
  if (!finished && !gone_ && !at_once && Now() < reap_until_) return;
  UMockdevIoctlClient* client = std::exchange(reaping_, nullptr);
  if (finished) {
    ClientMemory(*child_).Put(reap_into_, *finished);
    umockdev_ioctl_client_complete(client, 0, 0);
  } else {
    umockdev_ioctl_client_complete(client, -1, gone_ ? ENODEV : EAGAIN);
  }
  g_object_unref(client);
}

void EmulatedBus::Impl::Run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      MutexLock lock(mutex_);
      const Nanoseconds now = Now();
      if (requests_ && !gone_) requests_->Serve(now);
      AnswerReap();
      std::optional<Nanoseconds> wake = comes_back_at_;
      const auto also = [&wake](Nanoseconds due) { wake = wake ? std::min(*wake, due) : due; };
      if (reaping_ != nullptr) also(reap_until_);
      if (requests_ && !gone_) {
        if (const auto next_urb_due = requests_->NextDue(now)) also(*next_urb_due);
      }
      const Nanoseconds wait = wake ? *wake - now : kIdlePoll;
      changed_.wait_for(lock, stop, std::max(wait, kMinWait),
                        [this]() REQUIRES(mutex_) { return std::exchange(poked_, false); });
    }
    UnplugIfItWants();
  }
}

void EmulatedBus::Impl::UnplugIfItWants() {
  std::shared_ptr<EmulatedDevice> device;
  std::optional<EmulatedDevice::Unplugged> unplugged;
  {
    const MutexLock lock(mutex_);
    device = device_;
    if (device) unplugged = device->TakeUnplugged();
  }
  if (unplugged) {
    Unplug();
    if (unplugged->back_after) {
      comes_back_ = device;
      comes_back_at_ = Now() + *unplugged->back_after;
    }
  } else if (!device && comes_back_at_ && Now() >= *comes_back_at_) {
    comes_back_at_.reset();
    Plug(std::exchange(comes_back_, nullptr));
  }
}

}  // namespace isotherm
