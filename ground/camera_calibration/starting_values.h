#pragma once

#include <functional>
#include <vector>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "ground/camera_calibration/bundle.h"
#include "ground/camera_calibration/target_detector.h"

namespace isotherm {

struct CalibrationInput;
struct RefusedImage;

/// The target in one camera's image of a view.
struct SeenTarget {
  int camera = 0;
  int view = 0;
  DetectedTarget detected;
};

/// Returns what a lens of `kind` begins with, from a Brown-Conrady one that OpenCV found.
BundleCamera AsStart(const LensParameters& found, LensKind kind);

struct StartingValues {
  BundleState state;
};

/// Looks for the target in all images. Those without it are added to `refused`. Fails if an image
/// has another size than the others of its camera.
Result<std::vector<SeenTarget>> DetectInAll(const CalibrationInput& input, ThreadPool& pool,
                                            const std::function<void(double)>& progress,
                                            std::vector<RefusedImage>& refused);

/// Says what is missing for a calibration: enough images of each camera and, of a pair of cameras,
/// enough that both took.
Status CheckViews(const CalibrationInput& input, const std::vector<SeenTarget>& seen);

/// Lenses and poses by OpenCV, from the centres of the features' images. Fails as CheckViews, and
/// if all views are parallel.
Result<StartingValues> FindStart(const CalibrationInput& input,
                                 const std::vector<SeenTarget>& seen);

}  // namespace isotherm
