#include "edge/timestamper/timestamper.h"

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

Timestamper::Timestamper(const TimestamperOptions& options, Sensor sensor, Nanoseconds rig_delay)
    : use_envelope_(options.estimator() == ENVELOPE),
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
