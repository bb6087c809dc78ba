#include "common/transport/sample_validator.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

constexpr std::uint32_t kMaxEdgePixels = 16384;  // As for CameraModel.
// Codes may expand noise a little; twice the raw size is beyond all of them.
constexpr std::size_t kMaxBytesPerPixel = 4;
// Tables that a code carries besides its pixels.
constexpr std::size_t kMaxCodeOverheadBytes = 4096;
constexpr double kAbsoluteZero_celsius = -kCelsiusZero_k;
constexpr double kMaxHousekeeping_celsius = 1000.0;  // No camera survives that.
// Thirty years: a camera's counter may be wild, but must not overflow a clock.
constexpr double kMaxSecondsSinceNuc = 1e9;
// A micrometre per unit: 16 bit would reach 6 cm.
constexpr double kMaxDepthScale = 1e6;
// Later times are bytes that are none, and would overflow sums of times.
constexpr std::int64_t kYear2100_ns = 4'102'444'800'000'000'000;
constexpr float kFractionTolerance = 1e-3F;  // Rounding of four floats.

std::optional<RefusalCause> CheckTemperature(double celsius) {
  if (std::isnan(celsius)) return std::nullopt;  // The camera does not say.
  if (std::isinf(celsius)) return RefusalCause::kNotFinite;
  if (celsius < kAbsoluteZero_celsius || celsius > kMaxHousekeeping_celsius) {
    return RefusalCause::kOutOfRange;
  }
  return std::nullopt;
}

std::optional<RefusalCause> CheckFractions(const CoverageFractions& fractions) {
  for (const float fraction :
       {fractions.good, fractions.acceptable, fractions.bad, fractions.never_measured}) {
    if (std::isinf(fraction)) return RefusalCause::kNotFinite;
    if (fraction < -kFractionTolerance || fraction > 1.0F + kFractionTolerance) {
      return RefusalCause::kOutOfRange;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<RefusalCause> CheckFinite(std::initializer_list<double> values) {
  if (std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return {};
  return RefusalCause::kNotFinite;
}

std::optional<RefusalCause> CheckFiniteOrUnknown(std::initializer_list<double> values) {
  if (std::ranges::none_of(values, [](double value) { return std::isinf(value); })) return {};
  return RefusalCause::kNotFinite;
}

std::optional<RefusalCause> CheckClockTime(std::int64_t time_ns) {
  if (time_ns < 0) return RefusalCause::kNegativeTime;
  if (time_ns > kYear2100_ns) return RefusalCause::kOutOfRange;
  return std::nullopt;
}

std::optional<RefusalCause> CheckFrame(const FrameFields& fields) {
  if (fields.width == 0 || fields.height == 0 || fields.width > kMaxEdgePixels ||
      fields.height > kMaxEdgePixels) {
    return RefusalCause::kImpossibleSize;
  }
  const std::size_t pixels = std::size_t{fields.width} * fields.height;
  if (pixels > kMaxFramePixels) return RefusalCause::kImpossibleSize;
  if (fields.payload_bytes == 0) return RefusalCause::kEmptyPayload;
  if (fields.payload_bytes > kMaxPayloadBytes ||
      fields.payload_bytes > pixels * kMaxBytesPerPixel + kMaxCodeOverheadBytes) {
    return RefusalCause::kOversizePayload;
  }
  if (CheckEnum(fields.encoding, kLastEncoding)) return RefusalCause::kUnknownEncoding;
  if (fields.capture_time_ns < 0 || fields.capture_sigma_ns < 0) {
    return RefusalCause::kNegativeTime;
  }
  if (fields.frame_number > kMaxFrameNumber) return RefusalCause::kImpossibleNumber;
  return std::nullopt;
}

std::optional<RefusalCause> CheckDepthScale(double units_per_metre) {
  if (!std::isfinite(units_per_metre)) return RefusalCause::kNotFinite;
  if (units_per_metre <= 0.0 || units_per_metre > kMaxDepthScale) return RefusalCause::kOutOfRange;
  return std::nullopt;
}

std::optional<RefusalCause> CheckThermalScale(const RadiometricScale& scale) {
  if (const auto cause = CheckFinite({scale.kelvin_per_count, scale.offset_kelvin})) return cause;
  if (!Validate(scale).ok()) return RefusalCause::kOutOfRange;
  return std::nullopt;
}

std::optional<RefusalCause> CheckThermal(const ThermalFields& fields) {
  if (const auto cause = CheckEnum(fields.nuc_state, NucState::kError)) return cause;
  if (const auto cause = CheckEnum(fields.nuc_source, NucSource::kInferred)) return cause;
  if (fields.has_seconds_since_nuc) {
    if (!std::isfinite(fields.seconds_since_nuc)) return RefusalCause::kNotFinite;
    if (fields.seconds_since_nuc < 0.0 || fields.seconds_since_nuc > kMaxSecondsSinceNuc) {
      return RefusalCause::kOutOfRange;
    }
  }
  for (const float celsius : {fields.fpa_celsius, fields.housing_celsius, fields.shutter_celsius}) {
    if (const auto cause = CheckTemperature(celsius)) return cause;
  }
  return std::nullopt;
}

std::optional<RefusalCause> CheckRig(const Rig& rig) {
  // A rig that nobody calibrated may be announced; what needs the calibration refuses.
  if (!rig.depth && !rig.thermal) {
    if (const auto cause = CheckThermalScale(rig.thermal_scale)) return cause;
    if (!Validate(rig.depth_sensor).ok() || !Validate(rig.thermal_sensor).ok())
      return RefusalCause::kOutOfRange;
    return CheckFinite({rig.depth_scale, rig.thermal_delay_s});
  }
  if (Validate(rig).ok()) return std::nullopt;
  return RefusalCause::kOutOfRange;
}

std::optional<RefusalCause> CheckStreamReceipt(const StreamReceipt& receipt) {
  if (receipt.next > kMaxFrameNumber + 1 || receipt.handled > receipt.next ||
      receipt.received > receipt.next) {
    return RefusalCause::kImpossibleNumber;
  }
  std::uint64_t from = 0;
  for (const FrameRange& hole : receipt.holes) {
    if (hole.first < from || hole.last < hole.first || hole.last >= receipt.next) {
      return RefusalCause::kImpossibleNumber;
    }
    from = hole.last + 1;
  }
  return std::nullopt;
}

std::optional<RefusalCause> CheckFeedback(const Feedback& feedback) {
  if (ToNanoseconds(feedback.capture_time) < 0) return RefusalCause::kNegativeTime;
  if (const auto cause = CheckFinite({feedback.covered_area_m2, feedback.next_gain_m2}))
    return cause;
  if (const auto cause = CheckFractions(feedback.model)) return cause;
  if (const auto cause = CheckFractions(feedback.view)) return cause;
  for (const StageLatency& latency : feedback.latencies) {
    if (const auto cause = CheckFinite({latency.p50_s, latency.p99_s})) return cause;
  }
  if (!feedback.pose_covariance) return std::nullopt;
  if (!feedback.pose_covariance->allFinite()) return RefusalCause::kNotFinite;
  if (!IsCovariance(*feedback.pose_covariance)) return RefusalCause::kOutOfRange;
  return std::nullopt;
}

}  // namespace isotherm
