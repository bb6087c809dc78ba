#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/frame/image.h"

namespace isotherm {

struct StillPoseOptions {
  /// So many frames in a row must be alike for a pose; of more, the first `max_frames` count.
  int min_frames = 8;
  int max_frames = 40;
  /// Images are depth in millimetres, whose edges flicker though nothing moves.
  bool is_depth = false;
};

/// Holds what was seen while the target stood still: the mean image, and single frames, which show
/// how much a measurement in one of them scatters.
struct StillPose {
  double begin_s = 0.0, end_s = 0.0;
  int frames = 0;
  Image<float> mean;
  std::vector<Image<float>> samples;
};

/// Finds, in a stream of images, where nothing moves: neighbouring images differ by noise only, and
/// not at edges. Offsets that all pixels have in common do not count. Depth images are compared
/// with the pose's first one (MovedFraction). NaN has no value. Thread-compatible.
class StillPoseFinder {
 public:
  explicit StillPoseFinder(const StillPoseOptions& options) : options_(options) {}

  /// Returns the pose that ended with this frame, if one did.
  std::optional<StillPose> Add(double time_s, const Image<float>& image);
  /// Returns the pose that the end of the stream ends.
  std::optional<StillPose> Finish();
  /// Frames of the present pose.
  int frames() const { return pose_.frames; }

 private:
  bool IsSame(const Image<float>& image) const;
  std::optional<StillPose> Close();
  void Take(double time_s, const Image<float>& image);

  const StillPoseOptions options_;
  Image<float> last_;
  StillPose pose_;
  Image<float> sum_;
  Image<std::uint16_t> counts_;
};

/// Returns whether two images of one camera differ by noise only.
bool LookAlike(const Image<float>& a, const Image<float>& b);

/// The fraction of the pixels of two depth images, in millimetres, that show in one what none of
/// the nine pixels around has in the other: what moved by more than an edge flickers. Pixels
/// without a value do not count; 1 for different sizes.
double MovedFraction(const Image<float>& a, const Image<float>& b);

}  // namespace isotherm
