#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "common/rig/rig.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Writes everything that is needed to go on with a scan later (docs/model-format.md). The file
/// appears only when it is complete. `progress` hears after each part which fraction is written.
Status SaveModel(const std::filesystem::path& path, const TsdfVolume& tsdf,
                 const ThermalVolume& thermal, const Rig& rig,
                 std::span<const RigidTransform> known_poses,
                 const std::function<void(double fraction)>& progress = {});

/// A model file that was opened and whose head was checked. Thread-compatible.
class ModelFile {
 public:
  /// kDataLoss for a file that is damaged or cut off, kInvalidArgument for one that is no model or
  /// of an unknown version. Messages name the file.
  static Result<std::unique_ptr<ModelFile>> Open(const std::filesystem::path& path);
  ~ModelFile();
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;

  /// Sets the volume that the model has. Refuses options that were set to another one.
  Status AdoptVolume(GroundOptions& options) const;
  /// Refuses a rig whose cameras differ from those that made the model.
  Status CheckRig(const Rig& rig) const;
  /// The cameras that made the model and T_thermal_depth, as far as it has them.
  Rig rig() const;
  const std::vector<RigidTransform>& known_poses() const;
  std::int32_t block_count() const;

  /// Fills empty volumes of the same grid. Reads in pieces; on failure they hold a part.
  Status ReadBlocks(TsdfVolume& tsdf, ThermalVolume& thermal) const;

 private:
  struct Content;
  explicit ModelFile(std::unique_ptr<Content> content);

  const std::unique_ptr<Content> content_;
};

}  // namespace isotherm
