#include "ground/scan/scan_model.h"

#include "ground/tsdf/raycaster.h"

namespace isotherm {

SurfaceMaps CastFullView(const ScanModel& model, double min_weight) {
  SurfaceMaps maps;
  Raycaster().Cast(model.tsdf(), model.rig.depth->WithoutDistortion(), model.view.T_map_depth,
                   static_cast<float>(min_weight), model.pool, maps);
  return maps;
}

}  // namespace isotherm
