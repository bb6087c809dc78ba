// A calibration in text format.
#include "common/rig/rig_calibration.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(isotherm::ParseRigCalibration(text, "rig"));
  return 0;
}
