#include "edge/openni/testing/record_oni.h"

#include <OpenNI.h>

#include <chrono>
#include <cstdint>
#include <thread>

namespace isotherm {
namespace {

constexpr const char* kFakeCamera = "fake-depth://0";
constexpr std::chrono::seconds kPatience{20};

Status Check(openni::Status status) {
  if (status == openni::STATUS_OK) return OkStatus();
  return Internal(openni::OpenNI::getExtendedError());
}

/// A library that is still in use takes a moment to see that the camera was plugged in, and has the
/// files that were played in its list as well.
Status Open(openni::Device& device) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  openni::Status opened = device.open(kFakeCamera);
  while (opened != openni::STATUS_OK && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
    opened = device.open(kFakeCamera);
  }
  return Check(opened);
}

/// The recorder's thread writes behind, and leaves out what is left when it is stopped: waits until
/// the file has not grown for a while.
void AwaitWritten(const std::filesystem::path& file) {
  constexpr std::chrono::seconds kQuiet{1};
  constexpr std::chrono::milliseconds kLook{20};
  std::uintmax_t size = 0;
  auto grown_at = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - grown_at < kQuiet) {
    std::this_thread::sleep_for(kLook);
    const std::uintmax_t now = std::filesystem::file_size(file);
    if (now != size) grown_at = std::chrono::steady_clock::now();
    size = now;
  }
}

Status Record(const std::filesystem::path& file, int frames) {
  openni::Device device;
  ISOTHERM_RETURN_IF_ERROR(Open(device));
  openni::VideoStream stream;
  ISOTHERM_RETURN_IF_ERROR(Check(stream.create(device, openni::SENSOR_DEPTH)));
  openni::VideoMode mode;
  mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_1_MM);
  mode.setResolution(320, 240);
  mode.setFps(60);
  ISOTHERM_RETURN_IF_ERROR(Check(stream.setVideoMode(mode)));
  stream.setMirroringEnabled(false);
  openni::Recorder recorder;
  ISOTHERM_RETURN_IF_ERROR(Check(recorder.create(file.c_str())));
  ISOTHERM_RETURN_IF_ERROR(Check(recorder.attach(stream)));
  ISOTHERM_RETURN_IF_ERROR(Check(stream.start()));
  ISOTHERM_RETURN_IF_ERROR(Check(recorder.start()));
  openni::VideoFrameRef frame;
  for (int i = 0; i < frames + 3; ++i) {
    ISOTHERM_RETURN_IF_ERROR(Check(stream.readFrame(&frame)));
  }
  stream.stop();
  AwaitWritten(file);
  recorder.stop();
  recorder.destroy();
  stream.destroy();
  device.close();
  return OkStatus();
}

}  // namespace

Status RecordOni(const std::filesystem::path& file, int frames) {
  ISOTHERM_RETURN_IF_ERROR(Check(openni::OpenNI::initialize()));
  const Status recorded = Record(file, frames);
  openni::OpenNI::shutdown();
  return recorded;
}

}  // namespace isotherm
