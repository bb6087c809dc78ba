#pragma once

#include <cstdint>

namespace isotherm {

/// Counter-based random numbers: the same for the same counters whatever the order or the thread.

/// 64 well-mixed bits (the finaliser of SplitMix64).
constexpr std::uint64_t MixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Start of an independent stream, e.g. one frame of one sensor.
constexpr std::uint64_t NoiseStream(std::uint64_t seed, std::uint64_t purpose,
                                    std::uint64_t index) {
  return MixBits(MixBits(MixBits(seed) ^ purpose) ^ index);
}

/// Uniform in [0, 1).
constexpr double UniformNoise(std::uint64_t stream, std::uint64_t counter) {
  return static_cast<double>(MixBits(stream + counter) >> 11) * 0x1.0p-53;
}

/// Mean 0, standard deviation 1, nearly normal (sum of eight bytes, never beyond 4.9).
constexpr float NormalNoise(std::uint64_t stream, std::uint64_t counter) {
  constexpr std::uint64_t kEvenBytes = 0x00ff00ff00ff00ffULL;
  const std::uint64_t bits = MixBits(stream + counter);
  const std::uint64_t pairs = (bits & kEvenBytes) + ((bits >> 8) & kEvenBytes);
  const std::uint64_t sum = (pairs * 0x0001000100010001ULL) >> 48;
  constexpr float kMean = 8.0F * 127.5F;
  constexpr float kSigma = 209.0179F;  // sqrt(8 (256^2 - 1) / 12)
  return (static_cast<float>(sum) - kMean) / kSigma;
}

}  // namespace isotherm
