#pragma once

#include <cstdint>
#include <string_view>

#include "ground/pipeline/thermal_stage.h"

namespace isotherm {

/// The work that a pipeline leaves out under load. It costs quality where the next frames do
/// not see the same again.
enum class LoadShedding : std::uint8_t {
  kNone,
  kHalfThermal,    ///< Every second thermal frame is left out ("behind").
  kSparseThermal,  ///< ThermalThinning::kSparse.
  kEverySecond,    ///< So too, and every second depth frame is tracked but not integrated.
  kEveryFourth,    ///< ThermalThinning::kScarce, and three of four are not integrated.
};

/// "half_thermal", as in stats.json.
inline std::string_view ToString(LoadShedding load_shedding) {
  switch (load_shedding) {
    case LoadShedding::kNone:
      return "none";
    case LoadShedding::kHalfThermal:
      return "half_thermal";
    case LoadShedding::kSparseThermal:
      return "sparse_thermal";
    case LoadShedding::kEverySecond:
      return "every_second";
    case LoadShedding::kEveryFourth:
      break;
  }
  return "every_fourth";
}

/// The thermal frames that are left out then.
inline ThermalThinning Thinning(LoadShedding load_shedding) {
  switch (load_shedding) {
    case LoadShedding::kNone:
      return ThermalThinning::kNone;
    case LoadShedding::kHalfThermal:
      return ThermalThinning::kEverySecond;
    case LoadShedding::kSparseThermal:
    case LoadShedding::kEverySecond:
      return ThermalThinning::kSparse;
    case LoadShedding::kEveryFourth:
      break;
  }
  return ThermalThinning::kScarce;
}

/// Returns of how many depth frames one is integrated.
inline int IntegrationStride(LoadShedding load_shedding) {
  if (load_shedding == LoadShedding::kEveryFourth) return 4;
  return load_shedding == LoadShedding::kEverySecond ? 2 : 1;
}

}  // namespace isotherm
