#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/rig/rig.h"

namespace isotherm {

/// One thermal image of a camera that rests before something of constant temperature.
struct DriftSample {
  double time_s = 0.0;
  int epoch = 0;                  ///< NUCs before it.
  double housing_change_k = 0.0;  ///< Since the NUC.
  double reading_celsius = 0.0;   ///< Mean of the image.
};

/// Tells what such images say.
struct DriftReport {
  HousingDrift drift;
  std::size_t frames = 0;
  int epochs = 0;
  double most_change_k = 0.0;  ///< Largest change of the housing within an epoch.
  /// Root mean square of how readings stray about the means of their epochs, as measured and
  /// corrected by what the other epochs tell. Kelvin.
  double before_k = 0.0, held_out_k = 0.0;

  /// Held out, less than half is left.
  bool IsKnown() const { return held_out_k < 0.5 * before_k; }
};

/// Finds the error of a reading per kelvin of the housing, by the slope that all epochs have in
/// common; what each epoch reads at its NUC is free. Refuses samples in which the housing hardly
/// changes, the message says what to do.
Result<DriftReport> FitHousingDrift(const std::vector<DriftSample>& samples);

/// The same for a recording. `rig` as for CalibrateReadings.
Result<DriftReport> FindHousingDrift(const std::filesystem::path& recording,
                                     std::optional<Rig>& rig,
                                     const std::function<void(double)>& progress);

}  // namespace isotherm
