#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>

#include "common/messages/messages.h"
#include "common/transport/refusal.h"

/// Checks of what a peer sent, on plain numbers as they arrived, before anything is allocated or
/// copied for them. Pure. The result is the first cause found, or nullopt if the sample can be
/// used.
namespace isotherm {

/// Four hundred years at 90 frames per second; whatever is higher was not counted.
inline constexpr std::uint64_t kMaxFrameNumber = std::uint64_t{1} << 40U;

/// A frame of either sensor, untrusted.
struct FrameFields {
  std::uint64_t frame_number = 0;
  std::int64_t capture_time_ns = 0;
  std::int64_t capture_sigma_ns = 0;
  std::uint8_t encoding = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::size_t payload_bytes = 0;
};

/// Holds what a thermal frame carries besides.
struct ThermalFields {
  std::uint8_t nuc_state = 0;
  std::uint8_t nuc_source = 0;
  bool has_seconds_since_nuc = false;
  double seconds_since_nuc = 0.0;
  float fpa_celsius = 0.0F;
  float housing_celsius = 0.0F;
  float shutter_celsius = 0.0F;
};

std::optional<RefusalCause> CheckFrame(const FrameFields& fields);
std::optional<RefusalCause> CheckDepthScale(double units_per_metre);
std::optional<RefusalCause> CheckThermalScale(const RadiometricScale& scale);
std::optional<RefusalCause> CheckThermal(const ThermalFields& fields);
std::optional<RefusalCause> CheckRig(const Rig& rig);
/// The counts must fit together and the holes must be ascending ranges below `next`.
std::optional<RefusalCause> CheckStreamReceipt(const StreamReceipt& receipt);
std::optional<RefusalCause> CheckFeedback(const Feedback& feedback);

/// A reading of a wall clock with which one wants to calculate: 1970 to 2100.
std::optional<RefusalCause> CheckClockTime(std::int64_t time_ns);

/// kNotFinite if any of `values` is.
std::optional<RefusalCause> CheckFinite(std::initializer_list<double> values);
/// kNotFinite if any of `values` is infinite; NaN stands for "not known".
std::optional<RefusalCause> CheckFiniteOrUnknown(std::initializer_list<double> values);

/// kUnknownValue if `raw` is above the last enumerator.
template <typename Enum>
std::optional<RefusalCause> CheckEnum(std::uint8_t raw, Enum last) {
  if (raw <= static_cast<std::uint8_t>(last)) return std::nullopt;
  return RefusalCause::kUnknownValue;
}

}  // namespace isotherm
