#include "ground/camera_calibration/calibration_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "common/base/read_file.h"
#include "common/base/units.h"
#include "common/codec/codec.h"
#include "common/dataset/dataset.h"
#include "common/dataset/text_lines.h"
#include "common/frame/frame.h"
#include "common/png/png.h"
#include "common/recording/recording.h"
#include "ground/camera_calibration/board_image.h"

namespace isotherm {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kMaxSide = 16384;

template <typename T>
Image<float> ToFloat(const Image<T>& values) {
  Image<float> image(values.width(), values.height());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = values.pixels()[i];
    // Of 16 bits, the first and the last are no values of a camera; of 8 bits they are.
    const bool none = sizeof(T) == 2 && (value == 0 || value == std::numeric_limits<T>::max());
    image.pixels()[i] = none ? kNoValue : static_cast<float>(value);
  }
  return image;
}

Image<float> InMillimetres(Image<float> depth, double depth_scale) {
  const auto mm_per_unit = static_cast<float>(kMmPerM / depth_scale);
  for (float& value : depth.pixels()) value *= mm_per_unit;
  return depth;
}

template <typename T, typename Decode>
Result<Image<float>> Decoded(std::span<const std::uint8_t> bytes, const PngHead& head,
                             const Decode& decode) {
  Image<T> image(static_cast<int>(head.width), static_cast<int>(head.height));
  if (Status status = decode(bytes, image); !status.ok()) return Err(status);
  return ToFloat(image);
}

Result<Image<float>> DecodeCalibrationImage(std::span<const std::uint8_t> bytes) {
  const Result<PngHead> head = ReadPngHead(bytes);
  if (!head) return Err(head.error());
  if (head->channels != 1) {
    return Err(DataLoss(fmt::format(
        "has {} channels: save it as the camera gives it, grey with 8 or 16 bits, not coloured",
        head->channels)));
  }
  if (head->width == 0 || head->height == 0 || head->width > kMaxSide || head->height > kMaxSide)
    return Err(DataLoss(fmt::format("has {} x {} pixels", head->width, head->height)));
  if (head->bits == 8) return Decoded<std::uint8_t>(bytes, *head, DecodeGrey8Png);
  if (head->bits == 16) return Decoded<std::uint16_t>(bytes, *head, DecodeGrey16Png);
  return Err(DataLoss(fmt::format("has {} bits per pixel: 8 or 16 are read", head->bits)));
}

/// The files of a folder, with times if a list gives them.
Result<std::vector<std::pair<std::filesystem::path, double>>> FilesOf(
    const std::filesystem::path& folder, CalibratedStream stream) {
  std::vector<std::pair<std::filesystem::path, double>> files;
  const std::filesystem::path list = folder / fmt::format("{}.txt", ToString(stream));
  std::error_code error;
  if (std::filesystem::exists(list, error)) {
    const Result<std::string> text = ReadTextFile(list);
    if (!text) return Err(text.error());
    const auto entries = ParseImageList(*text, list.string(), folder);
    if (!entries) return Err(entries.error());
    for (const ImageEntry& entry : *entries)
      files.emplace_back(entry.path, ToSeconds(entry.time.time_since_epoch()));
    return files;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".png") files.emplace_back(entry.path(), 0.0);
  }
  if (error)
    return Err(NotFound(fmt::format("{}: cannot be read: {}", folder.string(), error.message())));
  std::sort(files.begin(), files.end());
  return files;
}

/// Names of frames by the time since the first.
std::string NameOf(double since_start_s) { return fmt::format("{:.2f} s", since_start_s); }

/// The image of a frame that belongs to the stream and shows something.
std::optional<Image<float>> ImageOf(const RecordedItem& item, CalibratedStream stream,
                                    double& time_s) {
  if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
    if (stream != CalibratedStream::kThermal || !thermal->frame.valid) return std::nullopt;
    const auto image = DecodeTemperatures(thermal->frame.image);
    time_s = ToSeconds(thermal->frame.header.capture_time.time_since_epoch());
    return image ? std::optional(ToFloat(*image)) : std::nullopt;
  }
  const auto* depth = std::get_if<RecordedDepth>(&item);
  if (depth == nullptr || stream != CalibratedStream::kDepth) return std::nullopt;
  const auto image = Decode(depth->frame.image);
  time_s = ToSeconds(depth->frame.header.capture_time.time_since_epoch());
  if (!image) return std::nullopt;
  return CalibrationImage(*image, depth->frame.depth_scale);
}

double Overlap(const NamedImage& a, const NamedImage& b) {
  return std::min(a.end_s, b.end_s) - std::max(a.time_s, b.time_s);
}

}  // namespace

std::string_view ToString(CalibratedStream stream) {
  switch (stream) {
    case CalibratedStream::kThermal:
      return "thermal";
    case CalibratedStream::kDepth:
      return "depth";
    case CalibratedStream::kInfrared:
      return "infrared";
  }
  return "";
}

StillPoseOptions StillPosesOf(CalibratedStream stream) {
  StillPoseOptions options;
  options.is_depth = stream == CalibratedStream::kDepth;
  return options;
}

Image<float> CalibrationImage(const Image<std::uint16_t>& counts) { return ToFloat(counts); }

Image<float> CalibrationImage(const Image<std::uint16_t>& depth_raw, double depth_scale) {
  return InMillimetres(ToFloat(depth_raw), depth_scale);
}

NamedImage NamedImageOf(StillPose pose, std::string name, const CalibrationStream& stream) {
  if (stream.stream == CalibratedStream::kDepth) {
    pose.mean = BoardImage(pose.samples, stream.target);
    // Rims of single depth images wander; how far is in the mean's blur.
    pose.samples.clear();
  }
  return {std::move(name), pose.begin_s,         pose.end_s,
          pose.frames,     std::move(pose.mean), std::move(pose.samples)};
}

Result<Image<float>> ReadCalibrationImage(const std::filesystem::path& path) {
  constexpr std::uint64_t kMaxFileBytes = 256U << 20;
  const Result<std::string> file = ReadFile(path, kMaxFileBytes);
  if (!file) return Err(file.error());
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file->data()), file->size());
  Result<Image<float>> image = DecodeCalibrationImage(bytes);
  if (!image) return Err(image.error().WithContext(path.string()));
  return image;
}

Result<ImageSeries> ReadImageFolder(const std::filesystem::path& folder,
                                    const CalibrationStream& stream,
                                    const std::function<void(double)>& progress) {
  const auto files = FilesOf(folder, stream.stream);
  if (!files) return Err(files.error());
  if (files->empty())
    return Err(NotFound(fmt::format("{}: there is no PNG file and no {}.txt that names some",
                                    folder.string(), ToString(stream.stream))));
  ImageSeries series;
  series.source = folder.string();
  constexpr int kAnyNumber = 1;
  StillPoseOptions options = StillPosesOf(stream.stream);
  options.min_frames = kAnyNumber;
  StillPoseFinder finder(options);
  std::string name;
  const auto add = [&](std::optional<StillPose> pose) {
    if (pose) series.images.push_back(NamedImageOf(std::move(*pose), name, stream));
  };
  for (std::size_t i = 0; i < files->size(); ++i) {
    const auto& [path, time_s] = (*files)[i];
    Result<Image<float>> image = ReadCalibrationImage(path);
    if (!image) return Err(image.error());
    if (stream.stream == CalibratedStream::kDepth)
      *image = InMillimetres(std::move(*image), stream.depth_scale);
    std::optional<StillPose> ended = finder.Add(time_s, *image);
    if (ended) add(std::move(ended));
    if (name.empty() || finder.frames() == 1) name = path.filename().string();
    progress(static_cast<double>(i + 1) / static_cast<double>(files->size()));
  }
  add(finder.Finish());
  return series;
}

Result<ImageSeries> ReadStillPoses(const std::filesystem::path& recording,
                                   const CalibrationStream& stream,
                                   const std::function<void(double)>& progress) {
  const auto reader = RecordingReader::Open(recording);
  if (!reader) return Err(reader.error());
  ImageSeries series;
  series.source = recording.string();
  if (const Result<Rig> rig = (*reader)->ReadRig(); rig)
    series.serial =
        stream.stream == CalibratedStream::kThermal ? rig->thermal_serial : rig->depth_serial;
  std::uint64_t total = 0, read = 0, frames = 0;
  for (const auto& [topic, count] : (*reader)->info().messages_by_topic) total += count;
  StillPoseFinder finder(StillPosesOf(stream.stream));
  std::optional<double> start_s;
  const auto add = [&](std::optional<StillPose> pose) {
    if (!pose) return;
    std::string name = NameOf(pose->begin_s - *start_s);
    series.images.push_back(NamedImageOf(std::move(*pose), std::move(name), stream));
  };
  while (true) {
    const Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (item && !*item) break;
    if (++read, total > 0)
      progress(std::min(1.0, static_cast<double>(read) / static_cast<double>(total)));
    if (!item) continue;  // What of a damaged recording cannot be read is not needed either.
    double time_s = 0.0;
    const std::optional<Image<float>> image = ImageOf(**item, stream.stream, time_s);
    if (!image) continue;
    ++frames;
    if (!start_s) start_s = time_s;
    add(finder.Add(time_s, *image));
  }
  if (frames == 0) {
    return Err(FailedPrecondition(fmt::format("{}: there are no {} frames in the recording",
                                              recording.string(), ToString(stream.stream))));
  }
  add(finder.Finish());
  if (series.images.empty()) {
    return Err(
        FailedPrecondition(fmt::format("{}: in none of its {} {} frames anything rests: hold the "
                                       "target still for a second in each "
                                       "pose, best on a stand",
                                       recording.string(), frames, ToString(stream.stream))));
  }
  return series;
}

std::vector<CalibrationView> ViewsOf(ImageSeries series) {
  std::vector<CalibrationView> views;
  for (NamedImage& image : series.images)
    views.push_back({std::move(image.name), {std::move(image.image)}, {std::move(image.samples)}});
  return views;
}

std::vector<CalibrationView> PairViews(ImageSeries first, ImageSeries second) {
  std::vector<CalibrationView> views;
  std::vector<bool> used(second.images.size(), false);
  for (std::size_t i = 0; i < first.images.size(); ++i) {
    NamedImage& image = first.images[i];
    CalibrationView view{image.name, {Image<float>(), Image<float>()}, {{}, {}}};
    std::optional<std::size_t> partner;
    for (std::size_t j = 0; j < second.images.size(); ++j) {
      const bool same = image.time_s == 0.0 ? i == j : Overlap(image, second.images[j]) >= 0.0;
      if (!used[j] && same &&
          (!partner || Overlap(image, second.images[j]) > Overlap(image, second.images[*partner])))
        partner = j;
    }
    view.images[0] = std::move(image.image);
    view.samples[0] = std::move(image.samples);
    if (partner) {
      used[*partner] = true;
      view.images[1] = std::move(second.images[*partner].image);
      view.samples[1] = std::move(second.images[*partner].samples);
    }
    views.push_back(std::move(view));
  }
  for (std::size_t j = 0; j < second.images.size(); ++j) {
    if (used[j]) continue;
    NamedImage& image = second.images[j];
    views.push_back(
        {image.name, {Image<float>(), std::move(image.image)}, {{}, std::move(image.samples)}});
  }
  return views;
}

}  // namespace isotherm
