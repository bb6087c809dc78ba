#pragma once

#include <optional>

#include "common/frame/frame.h"
#include "common/frame/image.h"
#include "common/radiometry/smooth_surface.h"
#include "ground/offline/held_out_report.h"
#include "ground/renderer/view_maps.h"
#include "ground/scan/scan_model.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_rectifier.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {

/// Says how thermal frames that were held back are predicted.
struct HeldOutOptions {
  double max_gap_s = 0.0;   ///< Poses further apart are not interpolated between.
  float min_weight = 0.0F;  ///< Voxels that are lighter do not count.
  /// The scanned surface. nullopt: a temperature is predicted to be seen from everywhere as from
  /// where it was measured.
  std::optional<SmoothSurface> surface;
  ReadingCorrections corrections;  ///< Made of the frames, as they were for the model.
};

/// Predicts thermal frames by casting the model of a finished scan from where they were taken.
/// Thread-compatible.
class HeldOutViews {
 public:
  /// The pipeline of `scan` must outlive it. CheckThermalFusion(scan.rig) is ok.
  HeldOutViews(const ScanModel& scan, const HeldOutOptions& options);

  /// `frame` is valid (CHECK), `nuc` its own.
  void Compare(const ThermalFrame& frame, const NucAge& nuc);
  const HeldOutReport& report() const { return report_; }

 private:
  std::optional<RigidTransform> PoseAt(CaptureTime time) const;
  void ComparePixel(int x, int y, double shown_celsius);
  /// Returns the temperature that the camera should show in a pixel, by what the model has there,
  /// °C.
  double Predict(int x, int y, const PointMeasurement& measurement) const;

  const ScanModel scan_;
  const HeldOutOptions options_;
  const BandRadiance band_;
  ThermalRectifier rectifier_;
  Raycaster raycaster_;
  SurfaceMaps maps_;
  ViewMaps view_;
  Image<float> celsius_;
  HeldOutReport report_;
};

}  // namespace isotherm
