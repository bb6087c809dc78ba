#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/base/status.h"

namespace isotherm {

/// Shared memory for pixels on their way from a camera's process to the edge: a fixed number of
/// slots, so that it never grows. Pages that no frame needs stay without memory. Who may write
/// which slot is agreed over the socket. Thread-compatible.
class PixelSlots {
 public:
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

 private:
  PixelSlots() = default;

  int descriptor_ = -1;
  std::uint16_t* pixels_ = nullptr;
};

}  // namespace isotherm
