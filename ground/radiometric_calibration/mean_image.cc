#include "ground/radiometric_calibration/mean_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/frame/radiometric_scale.h"
#include "ground/camera_calibration/calibration_images.h"
#include "ground/radiometric_calibration/recorded_thermal.h"
#include "ground/thermal/nuc_epochs.h"
#include "ground/thermal/reading_corrections.h"

namespace isotherm {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
/// So many images of a recording in a row are averaged and compared with the first ones.
constexpr int kBlockFrames = 5;
/// Root mean square by which they may differ, kelvin. The noise of such a mean is far below, as is
/// a plate that warms up for a few seconds; a hole that moves by two pixels is far above.
constexpr double kMaxChange_k = 0.5;

/// Sums images up.
struct ImageSum {
  Image<double> sum;
  int frames = 0;

  void Add(const Image<float>& celsius) {
    if (frames == 0) sum = Image<double>(celsius.width(), celsius.height());
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum.pixels()[i] += static_cast<double>(celsius.pixels()[i]);
    ++frames;
  }
};

/// Root mean square of the difference between two means.
double Difference(const ImageSum& a, const ImageSum& b) {
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.sum.size(); ++i) {
    const double difference = a.sum.pixels()[i] / a.frames - b.sum.pixels()[i] / b.frames;
    if (std::isnan(difference)) continue;
    squares += difference * difference;
    ++count;
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
}

/// Averages images of a camera that rests, in the order of their times. Every `block_frames` of
/// them are compared with the first ones.
class Averager {
 public:
  explicit Averager(int block_frames) : block_frames_(block_frames) {}

  Status Add(const Image<float>& celsius) {
    if (all_.frames > 0 &&
        (celsius.width() != all_.sum.width() || celsius.height() != all_.sum.height())) {
      return FailedPrecondition(
          fmt::format("images of {} x {} and of {} x {} pixels are not of one camera",
                      all_.sum.width(), all_.sum.height(), celsius.width(), celsius.height()));
    }
    all_.Add(celsius);
    block_.Add(celsius);
    return block_.frames < block_frames_ ? OkStatus() : CloseBlock();
  }

  int frames() const { return all_.frames; }

  /// There are some images.
  Result<Image<float>> Finish() {
    if (block_.frames > 0 && first_.frames > 0) {
      if (Status status = CloseBlock(); !status.ok()) return Err(status);
    }
    Image<float> mean(all_.sum.width(), all_.sum.height());
    std::ranges::transform(all_.sum.pixels(), mean.pixels().begin(),
                           [&](double sum) { return static_cast<float>(sum / all_.frames); });
    return mean;
  }

 private:
  Status CloseBlock() {
    if (first_.frames == 0) first_ = block_;
    const double change_k = Difference(first_, block_);
    block_ = ImageSum();
    if (change_k <= kMaxChange_k) return OkStatus();
    return FailedPrecondition(fmt::format(
        "image {} differs from the first ones by {:.1f} K: the camera has to rest, and what it "
        "sees to keep its temperature",
        all_.frames, change_k));
  }

  const int block_frames_;
  ImageSum all_, first_, block_;
};

/// In °C; 0 has no value.
Image<float> ToCelsius(const Image<std::uint16_t>& counts, const RadiometricScale& scale) {
  Image<float> celsius(counts.width(), counts.height());
  std::ranges::transform(counts.pixels(), celsius.pixels().begin(), [&](std::uint16_t count) {
    return count == 0 ? kNoValue : scale.Celsius(count);
  });
  return celsius;
}

Status AverageRecording(const std::filesystem::path& path, std::optional<Rig>& rig,
                        const std::function<void(double)>& progress, Averager& averager) {
  NucEpochs epochs;
  const Status status = ReadThermalFrames(path, rig, progress, [&](const ThermalFrame& frame) {
    const NucAge nuc = epochs.Follow(frame);
    if (!frame.valid) return OkStatus();
    const auto drift = rig ? rig->thermal_sensor.housing_drift : std::nullopt;
    return averager.Add(ToCelsius(frame.temperature_raw, WithoutDrift(frame.scale, drift, nuc)));
  });
  if (!status.ok() || averager.frames() > 0) return status;
  return FailedPrecondition(
      fmt::format("{}: there is no valid thermal frame in the recording", path.string()));
}

/// Images of `files` hold units of `scale`.
Status AverageFiles(const std::vector<std::filesystem::path>& files, const RadiometricScale& scale,
                    const std::function<void(double)>& progress, Averager& averager) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    Result<Image<float>> image = ReadCalibrationImage(files[i]);
    if (!image) return image.error();
    // Units of temperatures begin at 173 K.
    if (std::ranges::all_of(image->pixels(), [](float v) { return !(v > 255.0F); })) {
      return FailedPrecondition(
          fmt::format("{}: has no temperatures: save it as the camera gives it, grey with 16 bits",
                      files[i].string()));
    }
    for (float& value : image->pixels())
      value = std::isnan(value) ? kNoValue : scale.Celsius(static_cast<double>(value));
    if (Status status = averager.Add(*image); !status.ok())
      return status.WithContext(files[i].string());
    progress(static_cast<double>(i + 1) / static_cast<double>(files.size()));
  }
  return OkStatus();
}

/// The PNG files of a folder by name, or the file itself.
Result<std::vector<std::filesystem::path>> PngFilesOf(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return std::vector{path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  if (error)
    return Err(NotFound(fmt::format("{}: cannot be read: {}", path.string(), error.message())));
  if (files.empty()) return Err(NotFound(fmt::format("{}: there is no PNG file", path.string())));
  std::ranges::sort(files);
  return files;
}

}  // namespace

Result<MeanImage> ReadMeanImage(const std::filesystem::path& path, std::optional<Rig>& rig,
                                const std::function<void(double)>& progress) {
  std::error_code error;
  const bool is_png = path.extension() == ".png" || std::filesystem::is_directory(path, error);
  Averager averager(is_png ? 1 : kBlockFrames);
  if (is_png) {
    const Result<std::vector<std::filesystem::path>> files = PngFilesOf(path);
    if (!files) return Err(files.error());
    const RadiometricScale scale = rig ? rig->thermal_scale : RadiometricScale();
    if (Status status = AverageFiles(*files, scale, progress, averager); !status.ok())
      return Err(status);
  } else if (Status status = AverageRecording(path, rig, progress, averager); !status.ok()) {
    return Err(status);
  }
  Result<Image<float>> mean = averager.Finish();
  if (!mean) return Err(mean.error().WithContext(path.string()));
  return MeanImage{std::move(*mean), averager.frames()};
}

}  // namespace isotherm
