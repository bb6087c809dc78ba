#include "ground/console/console_options.h"

#include <fmt/format.h>

namespace isotherm {
namespace {

Status CheckRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return OkStatus();
  return InvalidArgument(
      fmt::format("console.expert.{} must be {} to {}, got {}", name, low, high, value));
}

Status Validate(const ConsoleExpertOptions& o) {
  ISOTHERM_RETURN_IF_ERROR(CheckRange("max_viewers", o.max_viewers(), 1, 1000));
  // Longer than a frame's period, the copying would hold up the next frame.
  ISOTHERM_RETURN_IF_ERROR(CheckRange("copy_ms", o.copy_ms(), 0.05, 20.0));
  ISOTHERM_RETURN_IF_ERROR(CheckRange("mesh_cores", o.mesh_cores(), 0.01, 1.0));
  ISOTHERM_RETURN_IF_ERROR(CheckRange("refresh_s", o.refresh_s(), 0.05, 60.0));
  ISOTHERM_RETURN_IF_ERROR(CheckRange("image_hz", o.image_hz(), 0.1, 30.0));
  return CheckRange("viewer_mbit_s", o.viewer_mbit_s(), 0.1, 10'000.0);
}

}  // namespace

Status Validate(const ConsoleOptions& o) {
  if (o.port() < 0 || o.port() > 65'535) {
    return InvalidArgument(
        fmt::format("console.port must be 0 (any that is free) to 65535, got {}", o.port()));
  }
  if (o.address().empty())
    return InvalidArgument("console.address must be an address of this computer");
  if (o.certificate_file().empty() != o.key_file().empty())
    return InvalidArgument("console.certificate_file and console.key_file go together");
  return Validate(o.expert());
}

}  // namespace isotherm
