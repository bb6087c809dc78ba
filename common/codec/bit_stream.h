#pragma once

#include <cstdint>
#include <span>

/// Raw bits, lowest first.
namespace isotherm::codec {

/// Behind its end everything reads as zero and ok() is false. Thread-compatible.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes)
      : next_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  /// `count` at most 16.
  std::uint32_t Get(unsigned count) {
    if (pending_bits_ < count) Refill(count);
    const auto value = static_cast<std::uint32_t>(pending_ & ((std::uint64_t{1} << count) - 1));
    pending_ >>= count;
    pending_bits_ -= count;
    return value;
  }

  bool ok() const { return ok_; }
  /// True if all bytes were used and the bits that fill up the last one are zero.
  bool AtEnd() const { return next_ == end_ && pending_bits_ < 8 && pending_ == 0; }

 private:
  void Refill(unsigned needed) {
    if (end_ - next_ >= 8) [[likely]] {
      std::uint64_t bytes = 0;
      for (unsigned i = 0; i < 8; ++i) bytes |= static_cast<std::uint64_t>(next_[i]) << (8 * i);
      pending_ |= bytes << pending_bits_;
      next_ += (63 - pending_bits_) / 8;
      pending_bits_ |= 56U;
      return;
    }
    while (pending_bits_ <= 56 && next_ != end_) {
      pending_ |= static_cast<std::uint64_t>(*next_++) << pending_bits_;
      pending_bits_ += 8;
    }
    if (pending_bits_ >= needed) return;
    ok_ = false;
    pending_bits_ = needed;
  }

  const std::uint8_t* next_;
  const std::uint8_t* end_;
  std::uint64_t pending_ = 0;
  unsigned pending_bits_ = 0;
  bool ok_ = true;
};

}  // namespace isotherm::codec
