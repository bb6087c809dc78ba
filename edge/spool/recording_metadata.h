#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "common/recording/recording.h"

namespace isotherm {

/// A hundred years of a camera: a higher number in a recording is damage, and the ground refuses
/// such frames.
inline constexpr std::uint64_t kMaxFrameNumber = std::uint64_t{1} << 38U;

/// Returns what a recording's metadata `name` has as `key`; empty if there is nothing.
inline std::string MetadataText(const RecordingInfo& info, std::string_view name,
                                std::string_view key) {
  const auto values = info.metadata.find(std::string(name));
  if (values == info.metadata.end()) return {};
  const auto value = values->second.find(std::string(key));
  return value == values->second.end() ? std::string() : value->second;
}

/// The same if it is a number; nullopt if it is none.
inline std::optional<std::uint64_t> MetadataNumber(const RecordingInfo& info, std::string_view name,
                                                   std::string_view key) {
  const std::string text = MetadataText(info, name, key);
  const char* const end = text.data() + text.size();
  std::uint64_t number = 0;
  const auto [at, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || at != end) return std::nullopt;
  return number;
}

}  // namespace isotherm
