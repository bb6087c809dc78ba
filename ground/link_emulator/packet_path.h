#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <span>

#include "common/time/time_types.h"

namespace isotherm {

/// Says what happens to packets that go one way.
struct PathProperties {
  Nanoseconds delay{};  ///< Each packet takes so long.
  /// Up to this much more, evenly distributed and drawn for each packet: they overtake each other.
  Nanoseconds jitter{};
  double loss = 0.0;  ///< Fraction of packets that do not arrive, from 0 to 1.
  /// Mean time for which all of them get lost; the times between are such that `loss` is right. 0:
  /// each packet gets lost by itself.
  Nanoseconds burst{};
  double doubled = 0.0;     ///< Fraction of packets that arrive twice, from 0 to 1.
  double rate_bit_s = 0.0;  ///< 0: any number.
  /// Packets that would have to wait longer for their turn at that rate are lost.
  Nanoseconds max_wait = std::chrono::milliseconds(100);
};

/// Counts what became of packets that went one way.
struct PathCounts {
  std::uint64_t packets = 0;  ///< Counts those that were sent.
  std::uint64_t bytes = 0;    ///< Their size.
  std::uint64_t lost = 0;     ///< By chance.
  std::uint64_t refused = 0;  ///< They would have waited for too long.
  std::uint64_t doubled = 0;
};

/// One direction of a poor link: says of each packet when it arrives, and whether. Losses in bursts
/// follow Gilbert and Elliott: a link is good or bad, each for an exponentially distributed time,
/// and what is sent while it is bad gets lost. The same for the same seed. Pure: time enters
/// through arguments, and does not run backwards. Thread-compatible.
class PacketPath {
 public:
  /// Holds when a packet arrives: not at all, once or twice.
  class Arrivals {
   public:
    void Add(SteadyTime time) { times_.at(count_++) = time; }
    std::span<const SteadyTime> times() const { return {times_.data(), count_}; }

   private:
    std::array<SteadyTime, 2> times_{};
    std::size_t count_ = 0;
  };

  explicit PacketPath(std::uint64_t seed) : random_(seed) {}

  /// For packets that are sent from now on.
  void Set(const PathProperties& properties);
  /// A packet that was to arrive has found no room; it counts as one that would have had to wait.
  void Refuse() { ++counts_.refused; }
  /// A packet of `bytes` is sent at `now`.
  Arrivals Send(SteadyTime now, std::size_t bytes);

  const PathCounts& counts() const { return counts_; }

 private:
  double Uniform();  ///< In [0, 1).
  Nanoseconds Exponential(double mean_s);
  bool IsLost(SteadyTime now);
  SteadyTime ArrivalOf(SteadyTime sent);

  PathProperties properties_;
  PathCounts counts_;
  std::mt19937_64 random_;
  SteadyTime free_at_{};  ///< All that was sent before has gone out by then.
  bool is_bad_ = false;
  std::optional<SteadyTime> state_ends_;  ///< When the link becomes bad or good.
};

}  // namespace isotherm
