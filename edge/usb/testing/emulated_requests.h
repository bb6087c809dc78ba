#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "edge/usb/testing/client_memory.h"
#include "edge/usb/testing/emulated_device.h"

namespace isotherm {

/// The kernel's side of a device file: takes requests to transfer (URBs), has them served by the
/// device when their time on the bus has come, and gives them back. Thread-compatible.
class EmulatedRequests {
 public:
  /// `device` must outlive it.
  EmulatedRequests(EmulatedDevice& device, ClientMemory memory);

  /// Takes the request at `address` in the client. 0 or an error number.
  int Submit(std::uintptr_t address, Nanoseconds now);
  /// Cancels it. 0 or an error number.
  int Discard(std::uintptr_t address);
  /// The address of the next finished request, after its results were written to the client.
  std::optional<std::uintptr_t> Reap();
  bool HasFinished() const { return !finished_.empty(); }

  /// Serves what is due at `now`.
  void Serve(Nanoseconds now);
  /// Returns when something may be due; nullopt = nothing is in flight.
  std::optional<Nanoseconds> NextDue(Nanoseconds now) const;
  /// The cable came off: ends everything.
  void EndAll();

 private:
  /// Holds a transfer that the program submitted and has not been given back.
  struct Request {
    std::uintptr_t address = 0;
    std::uint8_t type = 0;
    std::uint8_t endpoint = 0;
    std::uintptr_t buffer = 0;
    std::size_t length = 0;
    std::size_t packets = 0;
    Nanoseconds due{0};  ///< End of its time on the bus (isochronous).
    int status = 0;
    std::size_t actual = 0;
  };
  void ServeControl(Request request);
  std::optional<std::vector<std::uint8_t>> Answer(const UsbControl& control, Bytes data,
                                                  std::size_t read_bytes);
  std::optional<std::vector<std::uint8_t>> Descriptor(std::uint16_t value) const;
  void ServeIsochronous(Request request);
  bool ServeBulk(Request& request, Nanoseconds now);
  void Finish(Request request, int status);

  EmulatedDevice& device_;
  const ClientMemory memory_;
  const EmulatedIdentity identity_;
  const Nanoseconds interval_;  ///< The bus's.
  std::deque<Request> in_flight_;
  std::deque<Request> finished_;
  std::deque<Request> withheld_;                         ///< Cancelled and not given back.
  std::map<std::uint8_t, Nanoseconds> isochronous_end_;  ///< Last request's end, by endpoint.
};

}  // namespace isotherm
