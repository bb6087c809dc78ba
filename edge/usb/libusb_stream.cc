#include "edge/usb/libusb_stream.h"

#include <fmt/format.h>
#include <libusb.h>

#include <utility>

#include "common/base/check.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

// Transfers that fail one after the other before the stream is given up.
constexpr int kMaxErrorsInARow = 16;
// The kernel gives cancelled transfers back within a bus interval or two.
constexpr milliseconds kMaxStopTime{500};
// Events are handled this long at a time until all are back.
constexpr milliseconds kStopTry{10};

void LIBUSB_CALL OnTransferDone(libusb_transfer* transfer) {
  static_cast<LibusbStream*>(transfer->user_data)->OnDone(transfer);
}

}  // namespace

/// A transfer with its buffer.
struct LibusbStream::Transfer {
  Transfer(int packets, std::size_t bytes)
      : libusb(libusb_alloc_transfer(packets)), buffer(bytes) {}
  ~Transfer() { libusb_free_transfer(libusb); }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  libusb_transfer* const libusb;
  std::vector<unsigned char> buffer;
  bool in_flight = false;
};

LibusbStream::LibusbStream(libusb_context* context, libusb_device_handle* handle,
                           const UsbStreamPlan& plan, const Clock& clock,
                           UsbDevice::PacketSink sink)
    : context_(context), handle_(handle), plan_(plan), clock_(clock), sink_(std::move(sink)) {}

LibusbStream::~LibusbStream() { CHECK(in_flight_ == 0); }

bool LibusbStream::Stop() {
  // Cancelling only asks: the kernel writes to the buffers until each transfer has come back.
  CancelAll();
  const SteadyTime end = clock_.SteadyNow() + kMaxStopTime;
  while (in_flight_ > 0 && clock_.SteadyNow() < end) {
    timeval wait{0, kStopTry.count() * 1000};
    libusb_handle_events_timeout_completed(context_, &wait, nullptr);
  }
  return in_flight_ == 0;
}

int LibusbStream::Start() {
  const bool isochronous = plan_.endpoint.kind == UsbTransferKind::kIsochronous;
  const int packets = isochronous ? plan_.packets_per_transfer : 0;
  const int bytes = isochronous ? packets * plan_.endpoint.packet_bytes : plan_.transfer_bytes;
  for (int i = 0; i < plan_.transfers; ++i) {
    auto transfer = std::make_unique<Transfer>(packets, static_cast<std::size_t>(bytes));
    if (isochronous) {
      libusb_fill_iso_transfer(transfer->libusb, handle_, plan_.endpoint.address,
                               transfer->buffer.data(), bytes, packets, OnTransferDone, this, 0);
      libusb_set_iso_packet_lengths(transfer->libusb,
                                    static_cast<unsigned>(plan_.endpoint.packet_bytes));
    } else {
      libusb_fill_bulk_transfer(transfer->libusb, handle_, plan_.endpoint.address,
                                transfer->buffer.data(), bytes, OnTransferDone, this, 0);
    }
    transfers_.push_back(std::move(transfer));
    if (const int code = Submit(*transfers_.back()); code != 0) return code;
  }
  return 0;
}

int LibusbStream::Submit(Transfer& transfer) {
  const int code = libusb_submit_transfer(transfer.libusb);
  transfer.in_flight = code == 0;
  if (code == 0) ++in_flight_;
  return code;
}

void LibusbStream::OnDone(libusb_transfer* done) {
  --in_flight_;
  Transfer* transfer = nullptr;
  for (const std::unique_ptr<Transfer>& one : transfers_) {
    if (one->libusb == done) transfer = one.get();
  }
  transfer->in_flight = false;
  if (done->status == LIBUSB_TRANSFER_NO_DEVICE) Fail(State::kGone, "unplugged");
  if (stopping_ || state_ != State::kRunning || done->status == LIBUSB_TRANSFER_CANCELLED) return;
  if (done->status == LIBUSB_TRANSFER_COMPLETED) {
    errors_in_a_row_ = 0;
    if (done->type == LIBUSB_TRANSFER_TYPE_ISOCHRONOUS) {
      HandOverIsochronous(*done);
    } else {
      HandOverBulk(*done);
    }
  } else if (done->status == LIBUSB_TRANSFER_STALL) {
    return Fail(State::kFailed, "the endpoint is halted");
  } else {
    sink_({{}, {clock_.Now(), clock_.SteadyNow()}, true});
    if (++errors_in_a_row_ >= kMaxErrorsInARow) {
      return Fail(State::kFailed, fmt::format("{} transfers failed in a row", errors_in_a_row_));
    }
  }
  const int code = Submit(*transfer);
  if (code == LIBUSB_ERROR_NO_DEVICE) return Fail(State::kGone, "unplugged");
  if (code != 0) Fail(State::kFailed, libusb_strerror(code));
}

void LibusbStream::HandOverIsochronous(const libusb_transfer& transfer) {
  const HostStamp now{clock_.Now(), clock_.SteadyNow()};
  const unsigned char* data = transfer.buffer;
  for (int i = 0; i < transfer.num_iso_packets; ++i) {
    const libusb_iso_packet_descriptor& packet = transfer.iso_packet_desc[i];
    // The transfer is reported when its last packet was on the bus; the packets before it were
    // there one interval earlier each.
    const Nanoseconds earlier = (transfer.num_iso_packets - 1 - i) * plan_.packet_interval;
    const bool lost = packet.status != LIBUSB_TRANSFER_COMPLETED;
    sink_({Bytes(data, packet.actual_length), {now.wall - earlier, now.steady - earlier}, lost});
    data += packet.length;
  }
}

void LibusbStream::HandOverBulk(const libusb_transfer& transfer) {
  sink_({Bytes(transfer.buffer, static_cast<std::size_t>(transfer.actual_length)),
         {clock_.Now(), clock_.SteadyNow()},
         false});
}

void LibusbStream::Fail(State state, std::string reason) {
  if (state_ != State::kRunning) return;
  state_ = state;
  failure_ = std::move(reason);
}

void LibusbStream::CancelAll() {
  stopping_ = true;
  for (const std::unique_ptr<Transfer>& transfer : transfers_) {
    if (transfer->in_flight) libusb_cancel_transfer(transfer->libusb);
  }
}

}  // namespace isotherm
