#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/rigid_transform.h"
#include "ground/calibration/calibration_verdict.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {

/// Tells what a scan says of the distances that its depth camera measures.
struct DepthAssessment {
  CheckVerdict verdict = CheckVerdict::kNotAssessed;
  /// How far distances are from those of the surface that all images made together, by place in the
  /// image, as a fraction: root mean square without noise, and its standard uncertainty.
  double uneven = 0.0, sigma = 0.0;
  double distance_m = 0.0;  ///< Mean of what was seen.
  int frames = 0;
};

/// From where on distances count as uneven. The surface bends with what all images bend in the same
/// way, so that little is left: of a swelling by 1.5 % to the corners, 0.02 to 0.03 % in scans of
/// three simulated scenes. A right camera leaves 0.002 %, with coarse voxels 0.005 %.
inline constexpr double kMaxUneven = 0.0001;

/// Compares depth images with the surface that a whole scan made of them, by place in the image: a
/// camera that swells towards the corners sees the same surface farther away there than in the
/// middle. What differs from image to image alone, as noise and poses do, does not add up.
/// Thread-compatible.
class DepthConsistency {
 public:
  static constexpr int kColumns = 8, kRows = 6;
  static constexpr int kBlocks = 10;  ///< Parts of the scan, by time.

  /// `depth_m` as measured (0 = no return), `surface` what an ideal camera of the same size sees of
  /// the model from `T_map_depth`, in map coordinates. `block` is the part of the scan, 0 to
  /// kBlocks - 1.
  void Add(const Image<float>& depth_m, const SurfaceMaps& surface,
           const RigidTransform& T_map_depth, int block);

  DepthAssessment Assess() const;

 private:
  struct Sum {
    double errors = 0.0;
    double frames = 0.0;
  };
  using Cells = std::array<Sum, kColumns * kRows>;

  std::array<Cells, kBlocks> blocks_{};
  double distances_m_ = 0.0;
  int frames_ = 0;
};

/// "ok, the same surface looks the same all over the image within 0.003 % (0.02 mm at 0.65 m)", as
/// the functions of calibration_verdict.h.
std::string DescribeDepth(const DepthAssessment& assessment);

}  // namespace isotherm
