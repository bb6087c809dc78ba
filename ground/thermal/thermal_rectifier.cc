#include "ground/thermal/thermal_rectifier.h"

#include <algorithm>
#include <limits>

#include "ground/thermal/thermal_kernel.h"

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kRowsPerTask = 8;

}  // namespace

ThermalRectifier::ThermalRectifier(const CameraModel& camera)
    : ideal_(camera.WithoutDistortion()),
      source_(camera.width, camera.height, -1),
      fraction_x_(camera.width, camera.height),
      fraction_y_(camera.width, camera.height) {
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d pixel = ProjectNormalized(camera, Unproject(ideal_, {u, v}));
      if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= camera.width - 1 &&
            pixel.y() <= camera.height - 1)) {
        continue;
      }
      const int x = std::min(static_cast<int>(pixel.x()), camera.width - 2);
      const int y = std::min(static_cast<int>(pixel.y()), camera.height - 2);
      source_.At(u, v) = y * camera.width + x;
      fraction_x_.At(u, v) = static_cast<float>(pixel.x() - x);
      fraction_y_.At(u, v) = static_cast<float>(pixel.y() - y);
    }
  }
}

void ThermalRectifier::Rectify(const Image<std::uint16_t>& centikelvin, int apron, ThreadPool& pool,
                               Image<float>& celsius) {
  const int width = ideal_.width;
  const int height = ideal_.height;
  image_.Resize(width, height);
  if (celsius.width() != width + 2 * apron || celsius.height() != height + 2 * apron)
    celsius = Image<float>(width + 2 * apron, height + 2 * apron, kNan);
  const int tasks = (height + kRowsPerTask - 1) / kRowsPerTask;
  pool.ParallelFor(tasks, [&](int task) {
    const auto begin = static_cast<std::size_t>(task * kRowsPerTask * width);
    const auto end =
        std::min(image_.size(), begin + static_cast<std::size_t>(kRowsPerTask * width));
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint16_t raw = centikelvin.data()[i];
      image_.data()[i] = raw == 0 ? kNan : static_cast<float>(raw) * 0.01F - 273.15F;
    }
  });
  pool.ParallelFor(tasks, [&](int task) {
    for (int v = task * kRowsPerTask; v < std::min(height, (task + 1) * kRowsPerTask); ++v) {
      ResampleRow({image_.data(), width, source_.Row(v).data(), fraction_x_.Row(v).data(),
                   fraction_y_.Row(v).data(), width},
                  celsius.Row(v + apron).data() + apron);
    }
  });
}

}  // namespace isotherm
