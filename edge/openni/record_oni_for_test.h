#pragma once

#include <OpenNI.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

namespace isotherm {

/// Opens the fake camera. A library that is still in use takes a moment to see that it was plugged
/// in, and has the files that were played in its list as well.
inline void OpenFakeCamera(openni::Device& device) {
  constexpr const char* kUri = "fake-depth://0";
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (device.open(kUri) != openni::STATUS_OK) {
    ASSERT_LT(std::chrono::steady_clock::now(), end) << openni::OpenNI::getExtendedError();
    std::this_thread::yield();
  }
}

/// Has OpenNI2's own recorder write at least `frames` frames of the fake camera, 320x240 at 60 Hz.
inline void RecordOni(const std::filesystem::path& file, int frames) {
  ASSERT_EQ(openni::OpenNI::initialize(), openni::STATUS_OK);
  {
    openni::Device device;
    ASSERT_NO_FATAL_FAILURE(OpenFakeCamera(device));
    openni::VideoStream stream;
    ASSERT_EQ(stream.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    openni::VideoMode mode;
    mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_1_MM);
    mode.setResolution(320, 240);
    mode.setFps(60);
    ASSERT_EQ(stream.setVideoMode(mode), openni::STATUS_OK);
    stream.setMirroringEnabled(false);
    openni::Recorder recorder;
    ASSERT_EQ(recorder.create(file.c_str()), openni::STATUS_OK);
    ASSERT_EQ(recorder.attach(stream), openni::STATUS_OK);
    ASSERT_EQ(stream.start(), openni::STATUS_OK);
    ASSERT_EQ(recorder.start(), openni::STATUS_OK);
    openni::VideoFrameRef frame;
    for (int i = 0; i < frames + 3; ++i) {
      ASSERT_EQ(stream.readFrame(&frame), openni::STATUS_OK);
    }
    recorder.stop();
    stream.stop();
    recorder.destroy();
    stream.destroy();
    device.close();
  }
  openni::OpenNI::shutdown();
}

}  // namespace isotherm
