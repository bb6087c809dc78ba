#include "edge/nuc/warm_up_wait.h"

#include <fmt/format.h>

#include <utility>

#include "edge/options/edge_options.pb.h"

namespace isotherm {

WarmUpWait::WarmUpWait(const NucOptions& options, bool is_camera, NucNotices& notices)
    : mode_(ModeOf(options, is_camera)), notices_(notices), watch_(options) {}

WarmUpWait::Mode WarmUpWait::ModeOf(const NucOptions& options, bool is_camera) {
  // A recording is as warm as it was.
  if (!is_camera || options.warm_up() == NucOptions::IGNORE) return Mode::kIgnore;
  return options.warm_up() == NucOptions::WAIT ? Mode::kWait : Mode::kWarn;
}

void WarmUpWait::Update(CaptureTime now, const ThermalHousekeeping& housekeeping) {
  using State = WarmUpWatch::State;
  if (mode_ == Mode::kIgnore) return;
  const State before = std::exchange(state_, watch_.Update(now, housekeeping));
  if (before == state_) return;
  if (state_ == State::kCold) NoteCold();
  if (state_ == State::kWarm && before == State::kCold)
    notices_.Add(LogLevel::kInfo, "the thermal camera is warm");
}

void WarmUpWait::NoteCold() {
  const std::string what =
      watch_.change()
          ? fmt::format("'s {} changes by {:+.2f} K/min (warm below {:.2f})", watch_.change()->part,
                        watch_.change()->k_per_min, watch_.change()->limit_k_per_min)
          : fmt::format(" tells no temperature: counted as warm in {:.0f} s",
                        ToSeconds(watch_.left()));
  notices_.Add(LogLevel::kWarning, fmt::format("the thermal camera{}; {}", what,
                                               is_waiting() ? "no temperatures are taken until then"
                                                            : "temperatures may be off"));
}

}  // namespace isotherm
