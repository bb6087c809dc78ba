#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <type_traits>

#include "common/transport/refusal.h"
#include "ground/subscriber/frame_stream.h"
#include "ground/subscriber/received_frame.h"

namespace isotherm {

/// The way of one stream from the link to its consumer: session, number and payload are checked,
/// the payload is unpacked, the order is restored. Item is ReceivedDepth or ReceivedThermal. No
/// DDS, no clock. Thread-compatible.
template <typename Item>
class FrameLane {
 public:
  using Encoded = std::remove_const_t<typename decltype(Item::encoded)::element_type>;
  using Consumer = std::function<void(Item)>;

  /// `refusals` must outlive the lane. `deliver` gets frames in order; `deliver_late` those behind
  /// the reorder window. Empty consumers are skipped.
  FrameLane(std::string_view name, Nanoseconds reorder_window, RefusalCounter* refusals,
            Consumer deliver, Consumer deliver_late);

  /// Takes a frame that has passed the transport's checks; true if it was good and new.
  bool Add(Encoded&& encoded, CaptureTime arrival, SteadyTime now);
  /// Delivers what is in order or has waited long enough.
  void DeliverDue(SteadyTime now);
  /// Delivers everything that waits, in order.
  void DeliverAll();

  const FrameStream<Item>& stream() const { return stream_; }

 private:
  using Stream = FrameStream<Item>;

  /// True if a frame with this header would be taken; counts it if not.
  bool IsWanted(const FrameHeader& header, typename Stream::Session session);
  void Refuse(RefusalCause cause, const FrameHeader& header);

  const std::string_view name_;
  RefusalCounter* const refusals_;
  const Consumer deliver_;
  const Consumer deliver_late_;
  Stream stream_;
};

extern template class FrameLane<ReceivedDepth>;
extern template class FrameLane<ReceivedThermal>;

}  // namespace isotherm
