#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "ground/camera_calibration/still_poses.h"
#include "ground/camera_calibration/target.h"
#include "ground/camera_calibration/target_calibration.h"

namespace isotherm {

/// One image for a calibration, or the mean of several of the same pose.
struct NamedImage {
  std::string name;
  double time_s = 0.0, end_s = 0.0;  ///< Without times: 0.
  int frames = 1;
  Image<float> image;
  std::vector<Image<float>> samples;  ///< Some of the frames, if there were several.
};

/// Images of one camera, in the order in which they were taken.
struct ImageSeries {
  std::string source;  ///< Folder or recording.
  std::string serial;  ///< The camera's; empty: not known.
  std::vector<NamedImage> images;
};

enum class CalibratedStream { kThermal, kDepth, kInfrared };
std::string_view ToString(CalibratedStream stream);

/// Reads a grey PNG with 8 or 16 bits per pixel; of 16 bits, 0 has no value, nor has 65535.
Result<Image<float>> ReadCalibrationImage(const std::filesystem::path& path);

/// Says what is read.
struct CalibrationStream {
  CalibratedStream stream = CalibratedStream::kThermal;
  /// Depth becomes images of its holes (BoardImage); for depth it must have some.
  CalibrationTarget target;
  double depth_scale = 1000.0;  ///< Units per metre of depth images in a folder.
};

/// Reads a folder: the images that its list (thermal.txt, depth.txt or infrared.txt) names, or else
/// its PNG files by name. Neighbours that look alike are averaged.
Result<ImageSeries> ReadImageFolder(const std::filesystem::path& folder,
                                    const CalibrationStream& stream,
                                    const std::function<void(double)>& progress);

/// Reads the poses of a recording in which nothing moved (StillPoseFinder).
Result<ImageSeries> ReadStillPoses(const std::filesystem::path& recording,
                                   const CalibrationStream& stream,
                                   const std::function<void(double)>& progress);

/// How still poses are found in a stream.
StillPoseOptions StillPosesOf(CalibratedStream stream);
/// A thermal frame's image: 0 and 65535 have no value.
Image<float> CalibrationImage(const Image<std::uint16_t>& counts);
/// A depth frame's, in millimetres.
Image<float> CalibrationImage(const Image<std::uint16_t>& depth_raw, double depth_scale);
/// A still pose as an image: that of depth shows the target's holes.
NamedImage NamedImageOf(StillPose pose, std::string name, const CalibrationStream& stream);

/// One camera's images as views.
std::vector<CalibrationView> ViewsOf(ImageSeries series);
/// Two cameras' images as views: those at the same place in both series if neither has times, else
/// those whose times overlap. What only one camera has is a view of its own.
std::vector<CalibrationView> PairViews(ImageSeries first, ImageSeries second);

}  // namespace isotherm
