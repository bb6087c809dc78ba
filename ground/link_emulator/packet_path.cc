#include "ground/link_emulator/packet_path.h"

#include <algorithm>
#include <cmath>

namespace isotherm {

void PacketPath::Set(const PathProperties& properties) {
  properties_ = properties;
  is_bad_ = false;
  state_ends_.reset();
}

PacketPath::Arrivals PacketPath::Send(SteadyTime now, std::size_t bytes) {
  ++counts_.packets;
  counts_.bytes += bytes;
  Arrivals arrivals;
  SteadyTime sent = now;
  if (properties_.rate_bit_s > 0.0) {
    constexpr double kBitsPerByte = 8.0;
    const SteadyTime turn = std::max(now, free_at_);
    if (turn - now > properties_.max_wait) {
      ++counts_.refused;
      return arrivals;
    }
    sent = turn + FromSeconds(kBitsPerByte * static_cast<double>(bytes) / properties_.rate_bit_s);
    free_at_ = sent;
  }
  if (IsLost(now)) {
    ++counts_.lost;
    return arrivals;
  }
  arrivals.Add(ArrivalOf(sent));
  if (properties_.doubled > 0.0 && Uniform() < properties_.doubled) {
    ++counts_.doubled;
    arrivals.Add(ArrivalOf(sent));
  }
  return arrivals;
}

double PacketPath::Uniform() {
  // As many random bits as a double holds, so that it is the same with every standard library.
  constexpr int kDoubleBits = 53;
  return std::ldexp(static_cast<double>(random_() >> (64 - kDoubleBits)), -kDoubleBits);
}

Nanoseconds PacketPath::Exponential(double mean_s) {
  return FromSeconds(-mean_s * std::log1p(-Uniform()));
}

bool PacketPath::IsLost(SteadyTime now) {
  if (properties_.loss <= 0.0) return false;
  if (properties_.loss >= 1.0) return true;
  if (properties_.burst <= Nanoseconds(0)) return Uniform() < properties_.loss;
  const auto duration = [this] {
    const double mean_good_s =
        ToSeconds(properties_.burst) * (1.0 - properties_.loss) / properties_.loss;
    // Neither zero, so that time goes on, nor beyond what a time can hold.
    constexpr double kMaxTime_s = 1e8;
    const double mean_s = is_bad_ ? ToSeconds(properties_.burst) : mean_good_s;
    return std::max(Nanoseconds(1), Exponential(std::min(mean_s, kMaxTime_s)));
  };
  if (!state_ends_) state_ends_ = now + duration();
  while (*state_ends_ <= now) {
    is_bad_ = !is_bad_;
    *state_ends_ += duration();
  }
  return is_bad_;
}

SteadyTime PacketPath::ArrivalOf(SteadyTime sent) {
  if (properties_.jitter <= Nanoseconds(0)) return sent + properties_.delay;
  return sent + properties_.delay + FromSeconds(Uniform() * ToSeconds(properties_.jitter));
}

}  // namespace isotherm
