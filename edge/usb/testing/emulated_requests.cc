#include "edge/usb/testing/emulated_requests.h"

#include <linux/usbdevice_fs.h>
#include <cerrno>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace isotherm {
namespace {

// How long a bulk endpoint with nothing to send is left alone.
constexpr Nanoseconds kBulkPoll = std::chrono::microseconds(500);

std::uintptr_t PacketAddress(std::uintptr_t urb, std::size_t index) {
  return urb + offsetof(usbdevfs_urb, iso_frame_desc) + index * sizeof(usbdevfs_iso_packet_desc);
}

}  // namespace

EmulatedRequests::EmulatedRequests(EmulatedDevice& device, ClientMemory memory)
    : device_(device),
      memory_(memory),
      identity_(device.identity()),
      interval_(identity_.high_speed ? 125'000 : 1'000'000) {}

int EmulatedRequests::Submit(std::uintptr_t address, Nanoseconds now) {
  const auto urb = memory_.Get<usbdevfs_urb>(address);
  Request request;
  request.address = address;
  request.type = urb.type;
  request.endpoint = urb.endpoint;
  request.buffer = reinterpret_cast<std::uintptr_t>(urb.buffer);
  request.length = static_cast<std::size_t>(urb.buffer_length);
  if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
    ServeControl(request);
    return 0;
  }
  if (urb.type == USBDEVFS_URB_TYPE_ISO) {
    request.packets = static_cast<std::size_t>(urb.number_of_packets);
    Nanoseconds& end = isochronous_end_[urb.endpoint];
    end = std::max(end, now) + static_cast<std::int64_t>(request.packets) * interval_;
    request.due = end;
  } else if (urb.type != USBDEVFS_URB_TYPE_BULK) {
    return EINVAL;
  }
  in_flight_.push_back(request);
  return 0;
}

int EmulatedRequests::Discard(std::uintptr_t address) {
  const auto found =
      std::find_if(in_flight_.begin(), in_flight_.end(),
                   [address](const Request& request) { return request.address == address; });
  if (found == in_flight_.end()) return EINVAL;
  const Request request = *found;
  in_flight_.erase(found);
  if (device_.GivesBackCancelled()) {
    Finish(request, -ENOENT);
  } else {
    withheld_.push_back(request);
  }
  return 0;
}

std::optional<std::uintptr_t> EmulatedRequests::Reap() {
  if (finished_.empty()) return std::nullopt;
  const Request request = finished_.front();
  finished_.pop_front();
  memory_.Put(request.address + offsetof(usbdevfs_urb, status), request.status);
  memory_.Put(request.address + offsetof(usbdevfs_urb, actual_length),
              static_cast<int>(request.actual));
  return request.address;
}

void EmulatedRequests::Serve(Nanoseconds now) {
  if (device_.GivesBackCancelled()) {
    for (const Request& request : std::exchange(withheld_, {})) Finish(request, -ENOENT);
  }
  std::deque<Request> waiting = std::exchange(in_flight_, {});
  while (!waiting.empty()) {
    Request request = waiting.front();
    waiting.pop_front();
    if (request.type == USBDEVFS_URB_TYPE_ISO && request.due <= now) {
      ServeIsochronous(request);
    } else if (request.type == USBDEVFS_URB_TYPE_ISO || !ServeBulk(request, now)) {
      in_flight_.push_back(request);
    }
  }
}

std::optional<Nanoseconds> EmulatedRequests::NextDue(Nanoseconds now) const {
  std::optional<Nanoseconds> next;
  if (!withheld_.empty()) next = now + kBulkPoll;
  for (const Request& request : in_flight_) {
    const bool isochronous = request.type == USBDEVFS_URB_TYPE_ISO;
    const Nanoseconds due = isochronous ? request.due : now + kBulkPoll;
    next = next ? std::min(*next, due) : due;
  }
  return next;
}

void EmulatedRequests::EndAll() {
  for (const Request& request : std::exchange(in_flight_, {})) Finish(request, -ESHUTDOWN);
  for (const Request& request : std::exchange(withheld_, {})) Finish(request, -ESHUTDOWN);
}

void EmulatedRequests::ServeControl(Request request) {
  const std::vector<std::uint8_t> bytes = memory_.Read(request.buffer, request.length);
  if (bytes.size() < 8) return Finish(request, -EPIPE);
  const UsbControl control{bytes[0], bytes[1], Le16(bytes, 2), Le16(bytes, 4)};
  const std::size_t wanted = Le16(bytes, 6);
  const bool reads = (control.request_type & 0x80) != 0;
  const auto answer =
      Answer(control, reads ? Bytes() : Bytes(bytes).subspan(8), reads ? wanted : 0);
  if (!answer) return Finish(request, -EPIPE);
  request.actual = reads ? std::min(answer->size(), wanted) : wanted;
  if (reads) memory_.Write(request.buffer + 8, answer->data(), request.actual);
  Finish(request, 0);
}

std::optional<std::vector<std::uint8_t>> EmulatedRequests::Answer(const UsbControl& control,
                                                                  Bytes data,
                                                                  std::size_t read_bytes) {
  constexpr std::uint8_t kGetDescriptor = 6;
  if (control.request_type == 0x80 && control.request == kGetDescriptor) {
    return Descriptor(control.value);
  }
  return device_.Control(control, data, read_bytes);
}

std::optional<std::vector<std::uint8_t>> EmulatedRequests::Descriptor(std::uint16_t value) const {
  constexpr int kConfiguration = 2;
  constexpr int kString = 3;
  const int type = value >> 8;
  const int index = value & 0xFF;
  if (type == kConfiguration && index == 0) return identity_.configuration;
  if (type != kString) return std::nullopt;
  if (index == 0) return std::vector<std::uint8_t>{4, kString, 0x09, 0x04};  // English.
  if (index != 1 && index != 2) return std::nullopt;
  const std::string& text = index == 1 ? identity_.product : identity_.serial;
  std::vector<std::uint8_t> bytes = {static_cast<std::uint8_t>(2 + 2 * text.size()), kString};
  for (const char character : text) {
    bytes.push_back(static_cast<std::uint8_t>(character));
    bytes.push_back(0);
  }
  return bytes;
}

void EmulatedRequests::ServeIsochronous(Request request) {
  const Nanoseconds start = request.due - static_cast<std::int64_t>(request.packets) * interval_;
  std::uintptr_t buffer = request.buffer;
  for (std::size_t i = 0; i < request.packets; ++i) {
    const std::uintptr_t address = PacketAddress(request.address, i);
    auto packet = memory_.Get<usbdevfs_iso_packet_desc>(address);
    const EmulatedPacket sent = device_.Isochronous(
        request.endpoint, start + static_cast<std::int64_t>(i) * interval_, packet.length);
    packet.actual_length =
        static_cast<unsigned>(std::min<std::size_t>(sent.bytes.size(), packet.length));
    packet.status = sent.lost ? static_cast<unsigned>(-EXDEV) : 0;
    memory_.Put(address, packet);
    memory_.Write(buffer, sent.bytes.data(), packet.actual_length);
    buffer += packet.length;
  }
  request.actual = request.length;
  Finish(request, 0);
}

bool EmulatedRequests::ServeBulk(Request& request, Nanoseconds now) {
  const auto sent = device_.Bulk(request.endpoint, now, request.length);
  if (!sent) return false;
  request.actual = std::min(sent->size(), request.length);
  memory_.Write(request.buffer, sent->data(), request.actual);
  Finish(request, 0);
  return true;
}

void EmulatedRequests::Finish(Request request, int status) {
  request.status = status;
  finished_.push_back(request);
}

}  // namespace isotherm
