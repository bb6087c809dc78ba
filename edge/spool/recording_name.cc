#include "edge/spool/recording_name.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <system_error>

namespace isotherm {
namespace {

/// Returns what tells sessions apart in names (Knuth's multiplicative hash).
std::uint32_t ShortName(std::uint64_t session) {
  return static_cast<std::uint32_t>((session * 0x9E3779B97F4A7C15U) >> 32U);
}

}  // namespace

std::optional<std::filesystem::path> RecordingPath(const std::string& record, CaptureTime now,
                                                   std::uint64_t session) {
  if (record == "off") return std::nullopt;
  const std::filesystem::path path = record;
  std::error_code ignored;
  if (path.has_filename() && !std::filesystem::is_directory(path, ignored)) return path;
  const std::time_t seconds =
      std::chrono::floor<std::chrono::seconds>(now.time_since_epoch()).count();
  return path /
         fmt::format("edge-{:%Y%m%d-%H%M%S}-{:08x}.mcap", fmt::gmtime(seconds), ShortName(session));
}

}  // namespace isotherm
