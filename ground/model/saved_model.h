#pragma once

#include <filesystem>
#include <functional>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "ground/atlas/sub_map.h"
#include "ground/model/model_file.h"

namespace isotherm {

/// Writes a sub-map with everything that is needed to go on with it. `progress` hears which
/// fraction is written.
Status SaveSubMap(const std::filesystem::path& path, const SubMap& map, const Rig& rig,
                  const std::function<void(double fraction)>& progress = {});

/// Fills an empty sub-map, whose volume must be the model's (ModelFile::AdoptVolume), with what was
/// saved. Refuses a rig whose cameras differ from those that made the model. After a failure the
/// sub-map must not be used.
Status LoadSubMap(const ModelFile& model, const Rig& rig, SubMap& map);

}  // namespace isotherm
