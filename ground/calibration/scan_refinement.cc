#include "ground/calibration/scan_refinement.h"

#include "ground/calibration/scan_views.h"
#include "ground/scan/scan_model.h"

namespace isotherm {
Result<Refinement> RefineByScan(const ScanModel& scan, const std::vector<StampedThermal>& frames,
                                const ThermalPlacement& before, const RefinementPrior& prior,
                                ScanViews& views, const std::function<void(double)>& progress,
                                const std::stop_token& stop) {
  views.row_readout_s = scan.rig.thermal_sensor.row_readout_s;
  const LookAgain look_again = [&](const ThermalPlacement& placement, double range_s,
                                   const std::function<void(double)>& seen) {
    views.thermal_camera = placement.camera;
    views.T_thermal_depth = placement.T_thermal_depth;
    views.delay_s = placement.delay_s;
    views.frames = frames;
    return AddSurface(scan, kFinestPoints, range_s, views, seen, stop);
  };
  return RefinePlacement(views, before, prior, look_again, scan.pool, progress, stop);
}

}  // namespace isotherm
