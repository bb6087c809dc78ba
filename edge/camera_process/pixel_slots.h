#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/base/status.h"
#include "common/frame/frame.h"

namespace isotherm {

/// Shared memory for pixels on their way from a camera's process to the edge: a fixed number of
/// slots, so that it never grows. Pages that no frame needs stay without memory. Which side
/// may write which slot is agreed over the socket. Neither side can change its size. Also holds the
/// camera's side's count of frames that it had no slot for, which is still there when that side has
/// ended, however it did. Thread-compatible.
class PixelSlots {
 public:
  /// A quarter of a second at 30 Hz for the edge to take frames. More: memory (8 MB a slot, if
  /// used) and older frames; fewer: a busy computer loses frames (docs/performance-log.md counts
  /// them).
  static constexpr int kSlots = 8;
  /// 2048 x 2048: more than any camera here has.
  static constexpr std::size_t kPixelsPerSlot = std::size_t{1} << 22U;

  static Result<PixelSlots> Create();
  /// Takes over the descriptor that another process created.
  static Result<PixelSlots> Attach(int descriptor);
  PixelSlots(PixelSlots&& other) noexcept;
  PixelSlots& operator=(PixelSlots&& other) noexcept;
  ~PixelSlots();

  /// 0 <= index < kSlots.
  std::span<std::uint16_t> slot(int index) const;
  int descriptor() const { return descriptor_; }

  /// A frame that found no slot free.
  void CountLeftOut(Sensor sensor) const { LeftOut(sensor).fetch_add(1); }
  std::uint64_t left_out(Sensor sensor) const { return LeftOut(sensor).load(); }

 private:
  using Counters = std::array<std::atomic<std::uint64_t>, 2>;  ///< By Sensor.
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "processes share it");
  std::atomic<std::uint64_t>& LeftOut(Sensor sensor) const {
    return (*counters_)[static_cast<std::size_t>(sensor)];
  }
  PixelSlots() = default;

  int descriptor_ = -1;
  std::uint16_t* pixels_ = nullptr;
  Counters* counters_ = nullptr;  ///< Behind the pixels.
};

}  // namespace isotherm
