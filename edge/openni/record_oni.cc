#include "edge/openni/record_oni.h"

#include <OpenNI.h>

#include <chrono>
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
  recorder.stop();
  stream.stop();
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
