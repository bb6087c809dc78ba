#include "edge/timestamper/timestamper.h"

#include "common/options/option_problems.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

int MedianWindow(const TimestamperOptions& options, Sensor sensor) {
  return sensor == Sensor::kDepth ? options.expert().depth_window()
                                  : options.expert().thermal_window();
}

EnvelopeOptions ToEnvelopeOptions(const TimestamperOptions& options, Sensor sensor) {
  return {.median_window = MedianWindow(options, sensor),
          .window_s = options.expert().envelope_window_s(),
          .max_skew_ppm = options.expert().max_skew_ppm(),
          .max_slew_ppm = options.expert().max_slew_ppm(),
          .early_limit_s = options.expert().early_limit_s(),
          .residual_limit_s = options.expert().residual_limit_s(),
          .residual_window_s = options.expert().residual_window_s(),
          .relearn_after_s = options.expert().relearn_after_s()};
}

}  // namespace

Status Validate(const TimestamperOptions& options) {
  OptionProblems problems("timestamper");
  problems.CheckRange("expert.depth_window", options.expert().depth_window(), 1, 1000);
  problems.CheckRange("expert.thermal_window", options.expert().thermal_window(), 1, 1000);
  problems.CheckRange("expert.depth_delay_s", options.expert().depth_delay_s(), -1.0, 1.0);
  problems.CheckRange("expert.thermal_delay_s", options.expert().thermal_delay_s(), -1.0, 1.0);
  problems.CheckRange("expert.envelope_window_s", options.expert().envelope_window_s(), 1.0, 600.0);
  problems.CheckRange("expert.max_skew_ppm", options.expert().max_skew_ppm(), 0.0, 100'000.0);
  problems.CheckRange("expert.max_slew_ppm", options.expert().max_slew_ppm(), 1.0, 100'000.0);
  problems.CheckRange("expert.early_limit_s", options.expert().early_limit_s(), 0.0001, 10.0);
  problems.CheckRange("expert.residual_limit_s", options.expert().residual_limit_s(), 0.0001, 10.0);
  problems.CheckRange("expert.residual_window_s", options.expert().residual_window_s(), 0.1,
                      options.expert().envelope_window_s());
  problems.CheckRange("expert.relearn_after_s", options.expert().relearn_after_s(), 0.1, 600.0);
  return problems.ToStatus();
}

Timestamper::Timestamper(const TimestamperOptions& options, Sensor sensor, Nanoseconds rig_delay)
    : use_envelope_(options.expert().estimator() == ENVELOPE),
      constant_delay_(FromSeconds(sensor == Sensor::kDepth ? options.expert().depth_delay_s()
                                                           : options.expert().thermal_delay_s()) +
                      rig_delay),
      median_(MedianWindow(options, sensor)),
      envelope_(ToEnvelopeOptions(options, sensor)),
      period_(ToEnvelopeOptions(options, sensor)) {}

Stamp Timestamper::Process(const RawFrame& frame, CaptureTime arrival) {
  // Frames without ticks are counted by their source, which goes on counting.
  if (frame.reopened) {
    median_.BeginCounter();
    envelope_.BeginCounter();
  }
  Stamp stamp = !frame.has_device_clock ? period_.Process(frame.frame_number, arrival)
                : use_envelope_         ? envelope_.Process(frame.device_ticks, arrival)
                                        : median_.Process(frame.device_ticks, arrival);
  stamp.time += constant_delay_;  // (5.5)
  if (last_stamp_ && stamp.time <= *last_stamp_) {
    stamp.time = *last_stamp_ + Nanoseconds(1);
    ++counts_.moved;
  }
  last_stamp_ = stamp.time;
  if (!stamp.synchronised) ++counts_.unsynchronised;
  return stamp;
}

StampingCounts Timestamper::counts() const {
  StampingCounts counts = counts_;
  counts.resets = median_.resets() + envelope_.resets() + envelope_.relearned() + period_.slips();
  return counts;
}

}  // namespace isotherm
