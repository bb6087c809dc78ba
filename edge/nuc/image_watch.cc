#include "edge/nuc/image_watch.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/frame/frame.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// Frames whose least spread the scene is known by: a shutter takes one or two to close.
constexpr std::size_t kSceneFrames = 8;
// A scene with less spread cannot be told from a shutter, whose image has noise and some shading.
constexpr double kMinSceneSpread_k = 0.5;
// One pixel in this many, in both directions, is enough for the spread.
constexpr int kStride = 4;

}  // namespace

double ImageSpread(const Image<std::uint16_t>& temperature_raw, const RadiometricScale& scale) {
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (int y = 0; y < temperature_raw.height(); y += kStride) {
    const std::span<const std::uint16_t> row = temperature_raw.Row(y);
    for (std::size_t x = 0; x < row.size(); x += kStride) {
      if (row[x] == 0) continue;
      const double kelvin = scale.Kelvin(row[x]);
      count += 1.0;
      sum += kelvin;
      squares += kelvin * kelvin;
    }
  }
  if (count == 0.0) return 0.0;
  const double mean = sum / count;
  return std::sqrt(std::max(0.0, squares / count - mean * mean));
}

ImageWatch::ImageWatch(const NucOptions& options)
    : native_repeats_(options.expert().native_repeats()),
      uniform_fraction_(options.expert().shutter_like_spread()),
      longest_(FromSeconds(options.expert().max_duration_s())) {}

ImageEvidence ImageWatch::Add(const Image<std::uint16_t>& temperature_raw,
                              const RadiometricScale& scale, CaptureTime time, bool known_closed) {
  ImageEvidence evidence;
  evidence.is_frozen = IsFrozen(repeats_.Add(temperature_raw), native_repeats_);
  if (uniform_fraction_ > 0.0 && !evidence.is_frozen) {
    evidence.is_like_shutter =
        IsLikeShutter(ImageSpread(temperature_raw, scale), time, known_closed);
  }
  return evidence;
}

bool ImageWatch::IsLikeShutter(double spread_k, CaptureTime time, bool known_closed) {
  if (known_closed) {
    uniform_since_.reset();
    return false;
  }
  const bool knows_scene = scene_spreads_k_.size() == kSceneFrames;
  const double scene_k = knows_scene ? *std::ranges::min_element(scene_spreads_k_) : 0.0;
  const bool uniform = scene_k >= kMinSceneSpread_k && spread_k < uniform_fraction_ * scene_k;
  if (uniform) {
    if (!uniform_since_) uniform_since_ = time;
    if (time - *uniform_since_ <= longest_) return true;
    scene_spreads_k_.clear();  // No shutter is closed for so long: this is the scene.
  }
  uniform_since_.reset();
  scene_spreads_k_.push_back(spread_k);
  if (scene_spreads_k_.size() > kSceneFrames) scene_spreads_k_.pop_front();
  return false;
}

}  // namespace isotherm
