#pragma once

#include <array>
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
  /// Four words of 64 bits side by side, since each step of a hash waits for the one before.
  static constexpr std::size_t kLanes = 4;
  using Words = std::array<std::uint64_t, kLanes>;

  static std::uint64_t Mix(std::uint64_t hash, std::uint64_t word) {
    constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15ULL;  // 2^64 over the golden ratio.
    hash = (hash ^ word) * kMultiplier;
    return hash ^ hash >> 29U;
  }
  /// Equal images have equal hashes.
  static std::uint64_t Hash(const Image<std::uint16_t>& image) {
    const std::span<const std::byte> bytes = std::as_bytes(image.pixels());
    Words hashes = {1, 2, 3, 4};
    const auto add = [&](const Words& words) {
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        hashes[lane] = Mix(hashes[lane], words[lane]);
    };
    Words words{};
    std::size_t i = 0;
    for (; i + sizeof words <= bytes.size(); i += sizeof words) {
      std::memcpy(words.data(), bytes.data() + i, sizeof words);
      add(words);
    }
    if (i < bytes.size()) {
      words = {};
      std::memcpy(words.data(), bytes.data() + i, bytes.size() - i);
      add(words);
    }
    auto hash = static_cast<std::uint64_t>(image.width());
    for (const std::uint64_t lane : hashes) hash = Mix(hash, lane);
    return hash;
  }

  std::optional<std::uint64_t> last_hash_;
  int repeats_ = 0;
};

}  // namespace isotherm
