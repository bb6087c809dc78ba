#include "common/transport/frame_packet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/transport/testing/example_messages.h"

namespace isotherm {
namespace {

void ExpectSame(const FrameHeader& a, const FrameHeader& b) {
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.frame_number, b.frame_number);
  EXPECT_EQ(a.device_ticks, b.device_ticks);
  EXPECT_EQ(a.capture_time, b.capture_time);
  EXPECT_EQ(a.capture_sigma, b.capture_sigma);
}

void ExpectSame(const EncodedImage& a, const EncodedImage& b) {
  EXPECT_EQ(a.encoding, b.encoding);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.payload, b.payload);
}

FrameHeader MakeHeader() {
  return {.session = UINT64_MAX,
          .frame_number = 12,
          .device_ticks = DeviceTicks(std::chrono::microseconds(-33'333)),
          .capture_time = CaptureTimeFromNanoseconds(1'700'000'000'123'456'789),
          .capture_sigma = std::chrono::microseconds(250)};
}

TEST(FramePacketTest, ADepthFrameIsWhatItWas) {
  auto sent = Good<EncodedDepthFrame>();
  sent.header = MakeHeader();
  sent.depth_scale = 5000.5;
  EncodedDepthFrame received;
  ASSERT_EQ(UnpackFrame(PackFrame(sent), &received), std::nullopt);
  ExpectSame(received.header, sent.header);
  ExpectSame(received.image, sent.image);
  EXPECT_EQ(received.depth_scale, sent.depth_scale);
}

TEST(FramePacketTest, AThermalFrameIsWhatItWas) {
  auto sent = Good<EncodedThermalFrame>();
  sent.header = MakeHeader();
  sent.nuc_state = NucState::kSettling;
  sent.nuc_source = NucSource::kPolled;
  sent.seconds_since_nuc = 12.5;
  sent.housekeeping.fpa_celsius = 31.25F;
  sent.valid = true;
  EncodedThermalFrame received;
  ASSERT_EQ(UnpackFrame(PackFrame(sent), &received), std::nullopt);
  ExpectSame(received.header, sent.header);
  ExpectSame(received.image, sent.image);
  EXPECT_EQ(received.nuc_state, sent.nuc_state);
  EXPECT_EQ(received.nuc_source, sent.nuc_source);
  EXPECT_EQ(received.seconds_since_nuc, sent.seconds_since_nuc);
  EXPECT_EQ(received.housekeeping.fpa_celsius, 31.25F);
  EXPECT_TRUE(std::isnan(received.housekeeping.shutter_celsius));
  EXPECT_EQ(received.valid, sent.valid);
  EXPECT_EQ(received.scale.kelvin_per_count, sent.scale.kelvin_per_count);
  EXPECT_EQ(received.scale.offset_kelvin, sent.scale.offset_kelvin);

  sent.seconds_since_nuc.reset();
  ASSERT_EQ(UnpackFrame(PackFrame(sent), &received), std::nullopt);
}

TEST(FramePacketTest, TheRulesAreThoseOfWholeFrames) {
  EncodedDepthFrame received;
  auto sent = Good<EncodedDepthFrame>();
  sent.depth_scale = 0.0;
  EXPECT_EQ(UnpackFrame(PackFrame(sent), &received), RefusalCause::kOutOfRange);
  sent = Good<EncodedDepthFrame>();
  sent.image.width = 0;
  EXPECT_EQ(UnpackFrame(PackFrame(sent), &received), RefusalCause::kImpossibleSize);
  sent = Good<EncodedDepthFrame>();
  sent.image.payload.clear();
  EXPECT_EQ(UnpackFrame(PackFrame(sent), &received), RefusalCause::kEmptyPayload);
  EXPECT_EQ(UnpackFrame(PackFrame(Good<EncodedThermalFrame>()), &received),
            RefusalCause::kIncomplete)
      << "it is of the other camera";
  EXPECT_EQ(UnpackFrame({}, &received), RefusalCause::kIncomplete);
}

}  // namespace
}  // namespace isotherm
