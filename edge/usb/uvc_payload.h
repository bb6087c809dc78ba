#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/time/time_types.h"
#include "edge/usb/bytes.h"

namespace isotherm {

/// Both clocks of this computer, read together.
struct HostStamp {
  CaptureTime wall{};
  SteadyTime steady{};
};

/// Header of a UVC payload (UVC 1.5, section 2.4.3.3).
struct UvcPayloadHeader {
  std::size_t length = 0;
  bool frame_id = false;      ///< Toggles with each frame.
  bool end_of_frame = false;  ///< The last payload of a frame, where the camera says so.
  bool error = false;
  std::optional<std::uint32_t> presentation_time;  ///< Camera clock.
  std::optional<std::uint32_t> source_clock;       ///< Camera clock when the payload was sent.
  std::optional<std::uint16_t> usb_frame;          ///< 11-bit number of the bus frame, 1 ms each.
};

/// Nullopt if the bytes cannot be a payload. A missing end-of-header bit is tolerated.
std::optional<UvcPayloadHeader> ParseUvcPayloadHeader(Bytes payload);

/// Holds an image as its packets were joined; it may be damaged.
struct UvcFrame {
  std::vector<std::uint8_t> bytes;  ///< As many as were negotiated; what is missing is 0.
  std::size_t received = 0;         ///< Bytes that came, at most those negotiated.
  bool incomplete = false;          ///< Packets are missing, were damaged, or were too many.
  HostStamp first_packet;
  HostStamp last_packet;
  std::optional<std::uint32_t> presentation_time;
  std::uint64_t dropped_before = 0;  ///< Finished frames before it that nobody took in time.
};

/// Finished frames until somebody takes them. At most `kMax` wait; older ones are dropped, and the
/// next one says how many. Thread-compatible.
class WaitingFrames {
 public:
  /// Frames come out of transfers in bursts; four are more than one transfer finishes.
  static constexpr std::size_t kMax = 4;

  void Push(UvcFrame frame);
  std::optional<UvcFrame> Pop();
  bool empty() const { return frames_.empty(); }

 private:
  std::deque<UvcFrame> frames_;
};

/// Finds payloads in bulk transfers (UVC 1.5, section 2.4.3.2.1): one begins with a transfer, and
/// ends with a transfer that is not full or when it has the agreed size. Those that are longer than
/// a transfer are put together. Thread-compatible.
class UvcBulkJoiner {
 public:
  /// `transfer_bytes`: what a full transfer has; `max_payload_bytes`: as agreed with the camera.
  UvcBulkJoiner(std::size_t transfer_bytes, std::size_t max_payload_bytes)
      : transfer_bytes_(transfer_bytes), max_payload_bytes_(max_payload_bytes) {}

  /// Takes a transfer; true if it completes a payload.
  bool Add(Bytes transfer, const HostStamp& stamp);
  /// A transfer failed: where payloads begin is known again after the end of the one it was part
  /// of.
  void NoteLost();

  /// The payload that was completed, and when its first bytes came.
  Bytes payload() const { return payload_; }
  const HostStamp& first_stamp() const { return first_stamp_; }

 private:
  const std::size_t transfer_bytes_;
  const std::size_t max_payload_bytes_;
  std::vector<std::uint8_t> payload_;
  HostStamp first_stamp_;
  std::size_t received_ = 0;  ///< Bytes of the payload under way.
  bool skipping_ = false;     ///< Its beginning was lost.
};

/// Joins payloads to frames. A frame ends with the end-of-frame bit, or where the frame id toggles
/// without one; payloads between an end and the next toggle are strays. What came before the first
/// whole frame is left out, since a stream may start anywhere. Thread-compatible.
class UvcAssembler {
 public:
  explicit UvcAssembler(std::size_t frame_bytes) : frame_bytes_(frame_bytes) {}

  void AddPayload(Bytes payload, const HostStamp& stamp);
  /// The bus lost a packet: the frame it belongs to cannot be whole.
  void NoteLostPacket();
  /// The next finished frame.
  std::optional<UvcFrame> Pop() { return finished_.Pop(); }
  bool has_frame() const { return !finished_.empty(); }

  std::uint64_t bad_payloads() const { return bad_payloads_; }

 private:
  void Begin(const UvcPayloadHeader& header);
  void Append(const UvcPayloadHeader& header, Bytes data, const HostStamp& stamp);
  void Finish();

  const std::size_t frame_bytes_;
  UvcFrame frame_;
  bool in_frame_ = false;
  bool damaged_ = false;  ///< A packet was lost before the frame it may belong to began.
  bool seen_a_frame_ = false;
  std::optional<bool> frame_id_;
  WaitingFrames finished_;
  std::uint64_t bad_payloads_ = 0;
};

}  // namespace isotherm
