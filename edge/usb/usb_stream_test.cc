// UsbDevice with the genuine libusb on an emulated bus: what happens to transfers in flight. It is
// not watched by the thread sanitizer: libudev, beneath, seeds a table from two threads.

#include <gtest/gtest.h>

#include <atomic>

#include "edge/usb/testing/emulated_bus.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A limit for hanging.
constexpr seconds kPatience{20};
/// Half a second by its promise; the rest is for a computer that does something else.
constexpr seconds kStopsWithin{5};
constexpr int kTransfers = 4;
constexpr std::uint8_t kEndpoint = 0x81;

/// Has one bulk endpoint, and sends a byte for each transfer while it is told to.
class BulkDevice final : public EmulatedDevice {
 public:
  EmulatedIdentity identity() const override {
    EmulatedIdentity identity;
    identity.vendor_id = 0x1234;
    identity.product_id = 0x0001;
    identity.configuration = {9, 2, 25,        0, 1,  1,    0, 0x80, 50,  // One interface
                              9, 4, 0,         0, 1,  0xFF, 0, 0,    0,   // with one endpoint.
                              7, 5, kEndpoint, 2, 64, 0,    0};
    return identity;
  }
  std::optional<std::vector<std::uint8_t>> Control(const UsbControl&, Bytes, std::size_t) override {
    return std::nullopt;
  }
  void SetAlternate(int, int) override {}
  EmulatedPacket Isochronous(std::uint8_t, Nanoseconds, std::size_t) override { return {}; }
  std::optional<std::vector<std::uint8_t>> Bulk(std::uint8_t, Nanoseconds, std::size_t) override {
    if (!sends) return std::nullopt;
    return std::vector<std::uint8_t>{42};
  }
  bool GivesBackCancelled() const override { return gives_back; }
  std::optional<Unplugged> TakeUnplugged() override { return std::nullopt; }

  std::atomic<bool> sends{false};
  std::atomic<bool> gives_back{true};
};

class UsbStreamTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = EmulatedBus::Missing()) GTEST_SKIP() << *reason;
    bus_.emplace();
    bus_->Plug(camera_);
    auto device = UsbDevice::Open(EmulatedBus::kBusPort, clock_);
    ASSERT_TRUE(device.has_value()) << device.error().message();
    device_ = std::move(*device);
    ASSERT_TRUE(device_->Claim(0).ok());
  }
  void Start() {
    UsbStreamPlan plan;
    plan.endpoint = {kEndpoint, UsbTransferKind::kBulk, 64};
    plan.transfers = kTransfers;
    plan.transfer_bytes = 64;
    const Status started = device_->StartStream(plan, [this](const UsbPacket&) { ++packets_; });
    ASSERT_TRUE(started.ok()) << started.message();
  }
  /// Pumps until this many packets have come.
  void PumpUntil(int packets) {
    const SteadyTime end = clock_.SteadyNow() + kPatience;
    while (packets_ < packets && clock_.SteadyNow() < end) {
      ASSERT_TRUE(device_->Pump(milliseconds(20)).ok());
    }
    ASSERT_GE(packets_, packets);
  }

  const SystemClock clock_{};
  const std::shared_ptr<BulkDevice> camera_ = std::make_shared<BulkDevice>();
  std::optional<EmulatedBus> bus_;
  std::unique_ptr<UsbDevice> device_;
  int packets_ = 0;
};

TEST_F(UsbStreamTest, AStreamIsStoppedAndStartedAgain) {
  ASSERT_NO_FATAL_FAILURE(Start());
  camera_->sends = true;
  ASSERT_NO_FATAL_FAILURE(PumpUntil(10));
  device_->StopStream();
  const int packets = packets_;
  EXPECT_TRUE(device_->Pump(milliseconds(20)).ok());
  EXPECT_EQ(packets_, packets) << "handed over after it was stopped";
  ASSERT_NO_FATAL_FAILURE(Start());
  ASSERT_NO_FATAL_FAILURE(PumpUntil(packets + 10));
}

TEST_F(UsbStreamTest, TransfersThatComeBackLateFindTheirMemoryAndHandNothingOver) {
  ASSERT_NO_FATAL_FAILURE(Start());
  camera_->gives_back = false;
  const SteadyTime told = clock_.SteadyNow();
  device_->StopStream();
  EXPECT_LT(clock_.SteadyNow() - told, kStopsWithin);
  // The next stream's transfers tell when the late ones have come, too: in order.
  ASSERT_NO_FATAL_FAILURE(Start());
  camera_->gives_back = true;
  camera_->sends = true;
  ASSERT_NO_FATAL_FAILURE(PumpUntil(5 * kTransfers));
}

TEST_F(UsbStreamTest, ADeviceIsClosedInTimeAlthoughItsTransfersDoNotComeBack) {
  ASSERT_NO_FATAL_FAILURE(Start());
  camera_->gives_back = false;
  const SteadyTime told = clock_.SteadyNow();
  device_.reset();
  EXPECT_LT(clock_.SteadyNow() - told, kStopsWithin);
  camera_->gives_back = true;
  const auto again = UsbDevice::Open(EmulatedBus::kBusPort, clock_);
  EXPECT_TRUE(again.has_value()) << again.error().message();
}

}  // namespace
}  // namespace isotherm
