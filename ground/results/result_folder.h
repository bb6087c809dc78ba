#pragma once

#include <filesystem>
#include <optional>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

// A scan's result folder tells this to commands that go on with it.

/// `place` is a model.iso or a result folder with one in it. The model's file.
Result<std::filesystem::path> FindModel(const std::filesystem::path& place);

/// The configuration that a result folder was made with, from its stats.json; nullopt if it has
/// none that this version understands.
std::optional<GroundOptions> ConfigurationOf(const std::filesystem::path& folder);

/// T_world_depth, the last of trajectory.txt; nullopt if it has none.
std::optional<RigidTransform> LastPoseOf(const std::filesystem::path& folder);

}  // namespace isotherm
