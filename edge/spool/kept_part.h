#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/recording/recording.h"

namespace isotherm {

/// Files of a recording of which the newest is kept: each says what the recording had before it,
/// for by then those files may be deleted, and whether another one follows.

/// Holds what a recording has had of one stream.
struct StreamBefore {
  std::uint64_t frames = 0;  ///< Recorded, deleted since or not.
  std::uint64_t next = 0;    ///< One above the highest number.
};
using RecordedBefore = std::array<StreamBefore, 2>;  ///< By Sensor.

/// This metadata stands at the beginning of each file.
inline constexpr std::string_view kBeforeMetadata = "recorded_before";
std::map<std::string, std::string> ToMetadata(const RecordedBefore& before);
/// Returns what it says; nullopt if there is none, or it cannot be right.
std::optional<RecordedBefore> ReadRecordedBefore(const RecordingInfo& info);

/// This one stands at the end of each file that another one follows.
inline constexpr std::string_view kGoesOnMetadata = "goes_on";
inline bool GoesOn(const RecordingInfo& info) {
  return info.metadata.contains(std::string(kGoesOnMetadata));
}

}  // namespace isotherm
