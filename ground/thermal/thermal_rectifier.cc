#include "ground/thermal/thermal_rectifier.h"

#include <algorithm>
#include <limits>
#include <span>

#include "common/base/check.h"
#include "common/geometry/rectified_camera.h"
#include "common/radiometry/radiometry.h"
#include "ground/thermal/thermal_kernel.h"

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kRectifiedRowsPerTask = 8;

/// Returns the sum of the squares of the weights of linear interpolation between two values.
float SquaresOfWeights(float fraction) {
  return fraction * fraction + (1.0F - fraction) * (1.0F - fraction);
}

/// Turns temperatures that the model cannot hold into "no value".
void KeepRadiometric(std::span<float> celsius) {
  for (float& value : celsius) {
    const bool is_kept = value >= static_cast<float>(kMinRadiometric_celsius) &&
                         value <= static_cast<float>(kMaxRadiometric_celsius);
    value = is_kept ? value : kNan;
  }
}

}  // namespace

ThermalRectifier::ThermalRectifier(const CameraModel& camera, const ReadingCorrections& corrections)
    : camera_(camera),
      ideal_(RectifiedCamera(camera)),
      source_(ideal_.width, ideal_.height, -1),
      fraction_x_(ideal_.width, ideal_.height),
      fraction_y_(ideal_.width, ideal_.height),
      noise_gain_(ideal_.width, ideal_.height),
      radiometric_correction_(corrections.radiometric_correction) {
  const SceneInfluence& influence = corrections.scene_influence;
  if (influence.Total() > 0.0) corrector_.emplace(influence, camera.width, camera.height);
  const auto gain = static_cast<float>(1.0 / (1.0 - influence.Total()));
  for (int v = 0; v < ideal_.height; ++v) {
    for (int u = 0; u < ideal_.width; ++u) {
      const auto pixel = ProjectIntoImage(camera, Unproject(ideal_, {u, v}));
      if (!pixel || !(pixel->x() >= 0.0 && pixel->y() >= 0.0 && pixel->x() <= camera.width - 1 &&
                      pixel->y() <= camera.height - 1)) {
        continue;
      }
      const int x = std::min(static_cast<int>(pixel->x()), camera.width - 2);
      const int y = std::min(static_cast<int>(pixel->y()), camera.height - 2);
      source_.At(u, v) = y * camera.width + x;
      fraction_x_.At(u, v) = static_cast<float>(pixel->x() - x);
      fraction_y_.At(u, v) = static_cast<float>(pixel->y() - y);
      noise_gain_.At(u, v) = gain * gain * SquaresOfWeights(fraction_x_.At(u, v)) *
                             SquaresOfWeights(fraction_y_.At(u, v));
    }
  }
}

void ThermalRectifier::Rectify(const Image<std::uint16_t>& temperature_raw,
                               const RadiometricScale& scale, int apron, ThreadPool& pool,
                               Image<float>& celsius) {
  const int width = ideal_.width;
  const int height = ideal_.height;
  CHECK(temperature_raw.width() == camera_.width && temperature_raw.height() == camera_.height);
  image_.Resize(camera_.width, camera_.height);
  if (celsius.width() != width + 2 * apron || celsius.height() != height + 2 * apron)
    celsius = Image<float>(width + 2 * apron, height + 2 * apron, kNan);
  const auto finish_row = [this](std::span<float> row) {
    radiometric_correction_.Correct(row);
    KeepRadiometric(row);
  };
  // RadiometricScale::Celsius in single precision, which is right to 0.2 mK at 1500 °C.
  const auto kelvin_per_count = static_cast<float>(scale.kelvin_per_count);
  const auto zero_k = static_cast<float>(kCelsiusZero_k - scale.offset_kelvin);
  pool.ParallelForRows(camera_.height, kRectifiedRowsPerTask, [&](int y) {
    const std::span<const std::uint16_t> raw = temperature_raw.Row(y);
    const std::span<float> row = image_.Row(y);
    for (std::size_t x = 0; x < row.size(); ++x) {
      const float value = static_cast<float>(raw[x]) * kelvin_per_count - zero_k;
      row[x] = raw[x] == 0 ? kNan : value;
    }
    if (!corrector_) finish_row(row);
  });
  if (corrector_) {
    corrector_->Correct(image_);
    pool.ParallelForRows(camera_.height, kRectifiedRowsPerTask,
                         [&](int y) { finish_row(image_.Row(y)); });
  }
  pool.ParallelForRows(height, kRectifiedRowsPerTask, [&](int v) {
    ResampleRow({image_.data(), camera_.width, source_.Row(v).data(), fraction_x_.Row(v).data(),
                 fraction_y_.Row(v).data(), width},
                celsius.Row(v + apron).data() + apron);
  });
}

}  // namespace isotherm
