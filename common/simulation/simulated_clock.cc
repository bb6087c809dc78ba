#include "common/simulation/simulated_clock.h"

#include <cmath>

#include "common/base/noise.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {

SimulatedClock::SimulatedClock(const ClockOptions& options, double rate_hz, CaptureTime start,
                               CaptureTime first_exposure, std::uint64_t noise_stream)
    : rate_hz_(rate_hz),
      start_(start),
      first_exposure_(first_exposure),
      noise_stream_(noise_stream),
      offset_s_(options.offset_s()),
      drift_(options.drift_ppm() * 1e-6),
      delay_s_(options.delay_s()),
      jitter_s_(options.jitter_s()),
      impulse_fraction_(options.impulse_fraction()),
      impulse_max_s_(options.impulse_max_s()),
      wrap_us_(options.wrap_us()) {}

SimulatedFrameTime SimulatedClock::Next() {
  const double since_first_s = static_cast<double>(index_) / rate_hz_ / (1.0 + drift_);
  SimulatedFrameTime time;
  time.exposure = first_exposure_ + FromSeconds(since_first_s);

  const double device_s = offset_s_ + ToSeconds(time.exposure - start_) * (1.0 + drift_);
  auto ticks_us = static_cast<std::int64_t>(std::llround(device_s * 1e6));
  if (wrap_us_ > 0) ticks_us %= static_cast<std::int64_t>(wrap_us_);
  time.device_ticks = DeviceTicks(std::chrono::microseconds(ticks_us));

  const std::uint64_t counter = 3 * index_;
  double delay_s = delay_s_ - jitter_s_ * std::log1p(-UniformNoise(noise_stream_, counter));
  if (UniformNoise(noise_stream_, counter + 1) < impulse_fraction_) {
    delay_s += impulse_max_s_ * UniformNoise(noise_stream_, counter + 2);
  }
  time.arrival = time.exposure + FromSeconds(delay_s);
  constexpr Nanoseconds kTransfer =
      std::chrono::microseconds(50);  // A frame that waited for the one before.
  if (index_ > 0 && time.arrival < last_arrival_ + kTransfer)
    time.arrival = last_arrival_ + kTransfer;
  last_arrival_ = time.arrival;
  ++index_;
  return time;
}

}  // namespace isotherm
