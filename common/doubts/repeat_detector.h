#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "common/frame/image.h"

namespace isotherm {

/// Returns whether an image that came again `repeats` times in a row is frozen and no longer shows
/// the scene (failure F05), for a camera that sends each image `native_repeats` times (1 = once).
constexpr bool IsFrozen(int repeats, int native_repeats) {
  constexpr int kPerNative =
      3;  // A camera or driver that is late sends an image once or twice more.
  return repeats >= kPerNative * native_repeats;
}

/// Tells whether an image is bit for bit the one before it. No detector is free of noise, so such
/// an image says nothing new: the camera or its driver has sent the last one again. What follows
/// from that (leave it out, call the camera frozen) is for the caller. Images are compared by a
/// hash of 64 bits; none is kept. Thread-compatible.
class RepeatDetector {
 public:
  /// Takes the next image; returns how many times in a row it has come again, 0 for a new one.
  int Add(const Image<std::uint16_t>& image) {
    const std::uint64_t hash = Hash(image);
    repeats_ = hash == last_hash_ ? repeats_ + 1 : 0;
    last_hash_ = hash;
    return repeats_;
  }

 private:
  /// 64 bits at a time; equal images have equal hashes.
  static std::uint64_t Hash(const Image<std::uint16_t>& image) {
    constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15ULL;  // 2^64 over the golden ratio.
    std::uint64_t hash = static_cast<std::uint64_t>(image.width());
    const std::span<const std::byte> bytes = std::as_bytes(image.pixels());
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
      hash = (hash ^ word) * kMultiplier;
      hash ^= hash >> 29U;
    }
    return hash;
  }

  std::optional<std::uint64_t> last_hash_;
  int repeats_ = 0;
};

}  // namespace isotherm
