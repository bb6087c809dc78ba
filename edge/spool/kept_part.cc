#include "edge/spool/kept_part.h"

#include <charconv>
#include <system_error>

namespace isotherm {
namespace {

constexpr std::array kFramesKeys = {"depth_frames", "thermal_frames"};
constexpr std::array kNextKeys = {"next_depth_frame", "next_thermal_frame"};
/// A hundred years of a camera: more is damage.
constexpr std::uint64_t kMaxPlausible = std::uint64_t{1} << 38U;

std::optional<std::uint64_t> NumberAt(const std::map<std::string, std::string>& values,
                                      const char* key) {
  const auto found = values.find(key);
  if (found == values.end()) return std::nullopt;
  const char* const end = found->second.data() + found->second.size();
  std::uint64_t number = 0;
  const auto [at, error] = std::from_chars(found->second.data(), end, number);
  if (error != std::errc() || at != end || number > kMaxPlausible) return std::nullopt;
  return number;
}

}  // namespace

std::map<std::string, std::string> ToMetadata(const RecordedBefore& before) {
  std::map<std::string, std::string> values;
  for (std::size_t i = 0; i < before.size(); ++i) {
    values[kFramesKeys.at(i)] = std::to_string(before.at(i).frames);
    values[kNextKeys.at(i)] = std::to_string(before.at(i).next);
  }
  return values;
}

std::optional<RecordedBefore> ReadRecordedBefore(const RecordingInfo& info) {
  const auto values = info.metadata.find(std::string(kBeforeMetadata));
  if (values == info.metadata.end()) return std::nullopt;
  RecordedBefore before;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto frames = NumberAt(values->second, kFramesKeys.at(i));
    const auto next = NumberAt(values->second, kNextKeys.at(i));
    if (!frames || !next || *frames > *next) return std::nullopt;
    before.at(i) = {*frames, *next};
  }
  return before;
}

}  // namespace isotherm
