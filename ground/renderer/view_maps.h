#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/frame/image.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

class ThreadPool;

/// Holds what the model knows about the surface in one view, as numbers, height x width, row-major.
/// The renderings and the coverage summary start from here.
struct ViewMaps {
  Image<float> celsius;  ///< Apparent temperature; NaN = never measured or no surface.
  Image<std::uint8_t>
      distance_class;  ///< ConditionClass; kNeverMeasured = never measured or no surface.
  Image<std::uint8_t> angle_class;   ///< The same for the emission angle.
  Image<std::uint8_t> motion_class;  ///< The same for the smear; kNeverMeasured also = unchecked.
  Image<std::uint8_t> disagreement_class;  ///< The same for measurements against each other.
  Image<float>
      cos_view;  ///< |cos| of the angle between normal and line of sight; NaN = no surface.
  Image<float> distance_m;  ///< From the viewer to the surface; NaN = no surface.

  /// Says what the temperatures in `celsius` are, for legends.
  const char* celsius_meaning = "apparent temperature";

  // Of the measurements' records, NaN = not known. Empty unless SampleRecords was called.
  Image<float> nuc_age_s;           ///< Since the NUC before the measurement.
  Image<float> sigma_k;             ///< Standard uncertainty of `celsius`.
  Image<float> measured_angle_deg;  ///< Between its line of sight and the surface as it is now.

  int width() const { return celsius.width(); }
  int height() const { return celsius.height(); }
  void Resize(int width, int height);
  bool HasSurface(int x, int y) const { return cos_view.At(x, y) == cos_view.At(x, y); }
};

/// The quality of what a pixel with a surface shows.
MeasurementQuality QualityAt(const ViewMaps& view, int x, int y);

/// Looks up the surface in the thermal volume (algorithms 7-9, lines 4-7 and 9-10). `maps` in
/// `map`; `p_map_viewer` is where the ray-casting camera stood, metres. Rows in parallel; the
/// result does not depend on the number of threads.
void SampleView(const SurfaceMaps& maps, const Eigen::Vector3d& p_map_viewer,
                const TsdfVolume& tsdf, const ThermalVolume& thermal, ThreadPool& threads,
                ViewMaps& view);

/// Adds what the records of the measurements hold to a view of the same `maps`: their age since the
/// NUC and their uncertainty.
void SampleRecords(const SurfaceMaps& maps, const TsdfVolume& tsdf, const ThermalVolume& thermal,
                   ThreadPool& threads, ViewMaps& view);

}  // namespace isotherm
