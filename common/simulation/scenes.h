#pragma once

#include <vector>

#include "common/base/status.h"
#include "common/simulation/scan_path.h"
#include "common/simulation/scene.h"

namespace isotherm {

class SceneOptions;

/// Edge length of the cube that holds every scene but the flat wall, which goes on beyond it;
/// `world` has its origin in the cube's corner, x to the right, y down, z away from the operator.
inline constexpr double kSceneCube_m = 0.96;

/// A scene and how to scan it.
struct StagedScene {
  Scene scene;
  ScanPath path;
  /// These move with the rig and are behind it, as the operator is: they are seen in mirrors only.
  /// Poses are T_depth_primitive; materials are the scene's.
  std::vector<Primitive> carried;
};

/// The scene, with what is carried where it is for a rig at `T_world_depth`.
Scene SceneAround(const StagedScene& staged, const RigidTransform& T_world_depth);

/// The scene that the options name.
StagedScene MakeScene(const SceneOptions& options);

// One function per scene, in a file of the same name.
StagedScene MakeFurnaceDoorScene(const SceneOptions& options);
StagedScene MakeCalibratorScene(const SceneOptions& options);
StagedScene MakePlaneScene(const SceneOptions& options);
StagedScene MakeFlatWallScene(const SceneOptions& options);
StagedScene MakeAperturePlateScene(const SceneOptions& options);
StagedScene MakeCornerSphereScene(const SceneOptions& options);

}  // namespace isotherm
