#include "edge/openni/openni_settings.h"

#include <OpenNI.h>
#include <PS1080.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// The zero plane is described for the sensor's full width.
constexpr double kZeroPlaneWidth_px = 1280.0;
// Fields of view outside of 3 to 166 degrees are not a camera's, radians.
constexpr double kMinFov_rad = 0.05;
constexpr double kMaxFov_rad = 2.9;

std::string_view UnitText(openni::PixelFormat format) {
  switch (format) {
    case openni::PIXEL_FORMAT_DEPTH_1_MM:
      return "1 mm";
    case openni::PIXEL_FORMAT_DEPTH_100_UM:
      return "0.1 mm";
    default:
      return "";
  }
}

std::string ModeText(const openni::VideoMode& mode) {
  return fmt::format("{}x{}@{} {}", mode.getResolutionX(), mode.getResolutionY(), mode.getFps(),
                     UnitText(mode.getPixelFormat()));
}

openni::VideoMode WantedMode(const DepthCameraOptions& options) {
  openni::VideoMode mode;
  mode.setResolution(options.expert().width(), options.expert().height());
  mode.setFps(options.expert().rate_hz());
  mode.setPixelFormat(options.expert().unit() == TENTH_MILLIMETRE
                          ? openni::PIXEL_FORMAT_DEPTH_100_UM
                          : openni::PIXEL_FORMAT_DEPTH_1_MM);
  return mode;
}

Status SetMode(const DepthCameraOptions& options, openni::VideoStream& stream) {
  const openni::VideoMode wanted = WantedMode(options);
  const std::vector<std::string> modes = DepthModes(stream);
  // A driver may accept a mode that it does not have and run another: it is checked before and
  // after.
  if (std::find(modes.begin(), modes.end(), ModeText(wanted)) == modes.end()) {
    std::string has;
    for (const std::string& mode : modes) has += (has.empty() ? "" : ", ") + mode;
    return InvalidArgument(fmt::format("source.depth_camera: the camera has no mode {}; it has {}",
                                       ModeText(wanted), has.empty() ? "none for depth" : has));
  }
  if (stream.setVideoMode(wanted) != openni::STATUS_OK) {
    return Unavailable(fmt::format("the camera refuses {}: {}", ModeText(wanted), OpenniError()));
  }
  return OkStatus();
}

Status SetRegistration(bool on, openni::Device& device) {
  const auto mode = on ? openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR : openni::IMAGE_REGISTRATION_OFF;
  if (on && !device.isImageRegistrationModeSupported(mode)) {
    return InvalidArgument(
        "source.depth_camera.expert.registration: the camera cannot register depth");
  }
  // Cameras keep the setting of the program before; so it is set also when it is wanted off, and
  // read back.
  if (device.isPropertySupported(openni::DEVICE_PROPERTY_IMAGE_REGISTRATION)) {
    device.setImageRegistrationMode(mode);
  }
  const bool is_on = device.getImageRegistrationMode() != openni::IMAGE_REGISTRATION_OFF;
  if (is_on == on) return OkStatus();
  return Unavailable(fmt::format("the camera does not switch registration {}", on ? "on" : "off"));
}

Status SetCloseRange(bool on, openni::VideoStream& stream) {
  // An extension of PrimeSense's: not part of OpenNI2.
  if (!stream.isPropertySupported(XN_STREAM_PROPERTY_CLOSE_RANGE)) {
    return InvalidArgument(
        "source.depth_camera.expert.close_range: the camera has no such setting; leave it out");
  }
  const std::uint64_t value = on ? 1 : 0;
  if (stream.setProperty(XN_STREAM_PROPERTY_CLOSE_RANGE, value) != openni::STATUS_OK) {
    return Unavailable(fmt::format("close range cannot be set: {}", OpenniError()));
  }
  return OkStatus();
}

std::string CloseRangeText(const openni::VideoStream& stream) {
  std::uint64_t value = 0;
  if (!stream.isPropertySupported(XN_STREAM_PROPERTY_CLOSE_RANGE) ||
      stream.getProperty(XN_STREAM_PROPERTY_CLOSE_RANGE, &value) != openni::STATUS_OK) {
    return "not there";
  }
  return value != 0 ? "on" : "off";
}

/// Focal length in pixels of `size` pixels that see `fov_rad`; nullopt for nonsense.
std::optional<double> FocalLength(int size, double fov_rad) {
  if (!(fov_rad > kMinFov_rad && fov_rad < kMaxFov_rad)) return std::nullopt;
  return 0.5 * size / std::tan(0.5 * fov_rad);
}

std::optional<double> ZeroPlaneFocalLength(const openni::VideoStream& stream, int width) {
  std::uint64_t distance_mm = 0;
  double pixel_mm = 0.0;
  if (!stream.isPropertySupported(XN_STREAM_PROPERTY_ZERO_PLANE_DISTANCE) ||
      stream.getProperty(XN_STREAM_PROPERTY_ZERO_PLANE_DISTANCE, &distance_mm) !=
          openni::STATUS_OK ||
      stream.getProperty(XN_STREAM_PROPERTY_ZERO_PLANE_PIXEL_SIZE, &pixel_mm) !=
          openni::STATUS_OK ||
      distance_mm == 0 || !(pixel_mm > 0.0)) {
    return std::nullopt;
  }
  // A mode of half the width has pixels twice as wide.
  return static_cast<double>(distance_mm) / pixel_mm * width / kZeroPlaneWidth_px;
}

}  // namespace

OpenniLibrary::OpenniLibrary() {
  if (openni::OpenNI::initialize() != openni::STATUS_OK) {
    status_ = Unavailable(fmt::format("OpenNI2 cannot start: {}", OpenniError()));
  }
}

OpenniLibrary::~OpenniLibrary() { openni::OpenNI::shutdown(); }

std::string OpenniError() {
  std::string text = openni::OpenNI::getExtendedError();
  for (char& c : text) {
    // The library's messages have lines of their own; a log entry is one line.
    if (c == '\n' || c == '\t' || c == '\r') c = ' ';
  }
  const std::size_t end = text.find_last_not_of(' ');
  text.resize(end == std::string::npos ? 0 : end + 1);
  return text.empty() ? "no reason given" : text;
}

std::string SerialOf(const openni::Device& device) {
  // The last byte stays zero, whether or not the driver ends its text with one.
  char serial[256] = {};
  int size = sizeof(serial) - 1;
  if (!device.isPropertySupported(openni::DEVICE_PROPERTY_SERIAL_NUMBER) ||
      device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, serial, &size) !=
          openni::STATUS_OK) {
    return {};
  }
  return serial;
}

std::vector<std::string> DepthModes(const openni::VideoStream& stream) {
  std::vector<std::string> texts;
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  for (int i = 0; i < modes.getSize(); ++i) {
    if (!UnitText(modes[i].getPixelFormat()).empty()) texts.push_back(ModeText(modes[i]));
  }
  return texts;
}

Result<ActiveSettings> Configure(const DepthCameraOptions& options, openni::Device& device,
                                 openni::VideoStream& stream) {
  if (Status set = SetMode(options, stream); !set.ok()) return Err(std::move(set));
  if (Status set = SetRegistration(options.expert().registration(), device); !set.ok()) {
    return Err(std::move(set));
  }
  if (options.expert().has_close_range()) {
    if (Status set = SetCloseRange(options.expert().close_range(), stream); !set.ok()) {
      return Err(std::move(set));
    }
  }
  // Its answer does not count, what is read back does.
  if (stream.isPropertySupported(openni::STREAM_PROPERTY_MIRRORING)) {
    stream.setMirroringEnabled(false);
  }
  Result<ActiveSettings> active = ReadSettings(device, stream);
  if (!active) return active;
  const openni::VideoMode wanted = WantedMode(options);
  if (active->width != options.expert().width() || active->height != options.expert().height() ||
      active->rate_hz != options.expert().rate_hz() ||
      stream.getVideoMode().getPixelFormat() != wanted.getPixelFormat()) {
    return Err(Unavailable(fmt::format("the camera runs {} and not {}, which it had accepted",
                                       ModeText(stream.getVideoMode()), ModeText(wanted))));
  }
  return active;
}

Result<ActiveSettings> ReadSettings(const openni::Device& device,
                                    const openni::VideoStream& stream) {
  const openni::VideoMode mode = stream.getVideoMode();
  const std::string_view unit = UnitText(mode.getPixelFormat());
  if (unit.empty()) {
    return Err(DataLoss(fmt::format("depth in OpenNI2's format {}, which is not a length",
                                    static_cast<int>(mode.getPixelFormat()))));
  }
  ActiveSettings active;
  active.width = mode.getResolutionX();
  active.height = mode.getResolutionY();
  active.rate_hz = mode.getFps();
  active.depth_scale =
      mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM ? 10'000.0 : 1000.0;
  // Whatever was asked for: a driver that keeps mirroring is undone by the source.
  active.mirrored =
      stream.isPropertySupported(openni::STREAM_PROPERTY_MIRRORING) && stream.getMirroringEnabled();
  const bool registered = device.getImageRegistrationMode() != openni::IMAGE_REGISTRATION_OFF;
  active.text = fmt::format("unit {}, mirroring {}, registration {}, close range {}", unit,
                            active.mirrored ? "on (undone here)" : "off", registered ? "on" : "off",
                            CloseRangeText(stream));
  return active;
}

std::optional<CameraModel> NominalIntrinsics(const openni::VideoStream& stream, int width,
                                             int height) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  // Pixel centres are at integers.
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  const bool has_fov = stream.isPropertySupported(openni::STREAM_PROPERTY_HORIZONTAL_FOV) &&
                       stream.isPropertySupported(openni::STREAM_PROPERTY_VERTICAL_FOV);
  const auto fx = has_fov ? FocalLength(width, stream.getHorizontalFieldOfView()) : std::nullopt;
  const auto fy = has_fov ? FocalLength(height, stream.getVerticalFieldOfView()) : std::nullopt;
  if (fx && fy) {
    camera.fx = *fx;
    camera.fy = *fy;
    return camera;
  }
  // PrimeSense's own cameras tell their zero plane even where the field of view is missing.
  const std::optional<double> focal_length = ZeroPlaneFocalLength(stream, width);
  if (!focal_length) return std::nullopt;
  camera.fx = camera.fy = *focal_length;  // Its pixels are square.
  return camera;
}

}  // namespace isotherm
