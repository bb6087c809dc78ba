#include "common/recording/recording.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/codec/codec.h"
#include "common/recording/frame_protos.h"
#include "common/recording/recording_protos.h"
#include "common/recording/recording_topics.h"
#include "common/recording/schema.h"
#include "common/recording/testing/recording_data.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kScanStart;
using testing::MakeDepth;
using testing::MakeRig;
using testing::MakeScan;
using testing::MakeThermal;
using testing::ReadAll;
using testing::ReadBack;
using testing::ReaderOf;
using testing::TimeOf;
using testing::WriterTo;

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

class RecordingTest : public ::testing::TestWithParam<ImageStorage> {
 protected:
  std::shared_ptr<MemorySink::Disk> disk_ = std::make_shared<MemorySink::Disk>();
  RecordingOptions options_{.image_storage = GetParam()};

  std::unique_ptr<RecordingReader> Reader() {
    auto reader = ReaderOf(disk_->bytes);
    EXPECT_TRUE(reader) << reader.error().message();
    return reader ? std::move(*reader) : nullptr;
  }
};

TEST_P(RecordingTest, FramesComeBackAsTheyWere) {
  const EncodedDepthFrame depth = MakeDepth(7, kScanStart);
  EncodedThermalFrame thermal = MakeThermal(8, kScanStart + 1ms);
  {
    auto writer = WriterTo(disk_, options_);
    ASSERT_TRUE(writer->Write(depth, kScanStart + 5ms).ok());
    ASSERT_TRUE(writer->Write(thermal, std::nullopt).ok());
    ASSERT_TRUE(writer->Close().ok());
  }
  const auto reader = Reader();
  const ReadBack read = ReadAll(*reader);
  EXPECT_TRUE(reader->info().complete);
  ASSERT_EQ(read.items.size(), 2U);
  const auto recorded_depth = read.All<RecordedDepth>().at(0);
  ExpectSame(recorded_depth.frame.header, depth.header);
  ExpectSame(recorded_depth.frame.image, depth.image);
  EXPECT_EQ(recorded_depth.frame.depth_scale, depth.depth_scale);
  EXPECT_EQ(recorded_depth.arrival, kScanStart + 5ms);
  const auto recorded_thermal = read.All<RecordedThermal>().at(0);
  ExpectSame(recorded_thermal.frame.header, thermal.header);
  ExpectSame(recorded_thermal.frame.image, thermal.image);
  EXPECT_EQ(recorded_thermal.frame.nuc_state, thermal.nuc_state);
  EXPECT_EQ(recorded_thermal.frame.nuc_source, thermal.nuc_source);
  EXPECT_EQ(recorded_thermal.frame.seconds_since_nuc, thermal.seconds_since_nuc);
  EXPECT_EQ(recorded_thermal.frame.housekeeping.fpa_celsius, 31.25F);
  EXPECT_TRUE(std::isnan(recorded_thermal.frame.housekeeping.housing_celsius));
  EXPECT_TRUE(recorded_thermal.frame.valid);
  EXPECT_EQ(recorded_thermal.arrival, std::nullopt);
}

TEST_P(RecordingTest, TemperaturesComeBackInTheirScale) {
  EncodedThermalFrame thermal = MakeThermal(8, kScanStart);
  thermal.image.encoding = Encoding::kScaledRaw16;
  thermal.scale = {0.02, 12.5};
  Rig rig = MakeRig();
  rig.thermal_scale = thermal.scale;
  {
    auto writer = WriterTo(disk_, options_);
    ASSERT_TRUE(writer->Write(rig).ok());
    ASSERT_TRUE(writer->Write(thermal, kScanStart).ok());
    ASSERT_TRUE(writer->Close().ok());
  }
  const auto reader = Reader();
  const auto read_rig = reader->ReadRig();
  ASSERT_TRUE(read_rig.has_value());
  EXPECT_EQ(read_rig->thermal_scale, thermal.scale);
  const auto recorded = ReadAll(*reader).All<RecordedThermal>();
  ASSERT_EQ(recorded.size(), 1U);
  ExpectSame(recorded[0].frame.image, thermal.image);
  EXPECT_EQ(recorded[0].frame.scale, thermal.scale);
}

TEST_P(RecordingTest, TheRigThatWasWrittenLastHolds) {
  Rig rig = MakeRig();
  for (const bool has_frames_behind : {false, true}) {
    *disk_ = {};
    auto writer = WriterTo(disk_, options_);
    ASSERT_TRUE(writer->Write(rig).ok());
    // Copies of the first one stand in between.
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(writer->Write(MakeDepth(i, kScanStart + i * 12s), std::nullopt).ok());
    Rig anew = rig;
    anew.thermal_scale = {0.02, 12.5};
    ASSERT_TRUE(writer->Write(anew).ok());
    if (has_frames_behind) {
      ASSERT_TRUE(writer->Write(MakeDepth(3, kScanStart + 60s), std::nullopt).ok());
    }
    ASSERT_TRUE(writer->Close().ok());
    const auto reader = Reader();
    const Result<Rig> read = reader->ReadRig();
    ASSERT_TRUE(read.has_value()) << read.error().message();
    EXPECT_EQ(read->thermal_scale, anew.thermal_scale) << has_frames_behind;
    EXPECT_EQ(ReadAll(*reader).All<RecordedDepth>().size(), has_frames_behind ? 4U : 3U);
  }
}

TEST_P(RecordingTest, AScaleThatCannotBeIsDamage) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<RadiometricScale, const char*> cases[] = {
      {{0.0, 0.0}, "thermal_scale"},     {{-0.02, 0.0}, "thermal_scale"},
      {{kNan, 0.0}, "thermal_scale"},    {{1e300, 0.0}, "thermal_scale"},
      {{0.02, -kNan}, "thermal_offset"}, {{0.02, 1e300}, "thermal_offset"}};
  auto writer = WriterTo(disk_, options_);
  for (const auto& [scale, field] : cases) {
    EncodedThermalFrame thermal = MakeThermal(8, kScanStart);
    thermal.image.encoding = Encoding::kScaledRaw16;
    thermal.scale = scale;
    ASSERT_TRUE(writer->Write(thermal, kScanStart).ok());
  }
  ASSERT_TRUE(writer->Close().ok());
  const auto reader = Reader();
  for (const auto& [scale, field] : cases) {
    const auto item = reader->Next();
    ASSERT_FALSE(item.has_value());
    EXPECT_EQ(item.error().code(), StatusCode::kDataLoss);
    EXPECT_THAT(item.error().message(), AllOf(HasSubstr("/thermal"), HasSubstr(field)));
  }
}

TEST_P(RecordingTest, CountsComeBackAsCounts) {
  EncodedThermalFrame thermal = MakeThermal(8, kScanStart);
  thermal.image.encoding = Encoding::kCounts16;
  thermal.valid = false;
  {
    auto writer = WriterTo(disk_, options_);
    ASSERT_TRUE(writer->Write(thermal, kScanStart).ok());
    ASSERT_TRUE(writer->Close().ok());
  }
  const auto reader = Reader();
  const auto item = reader->Next();
  ASSERT_TRUE(item && *item);
  const auto* back = std::get_if<RecordedThermal>(&**item);
  ASSERT_NE(back, nullptr);
  ExpectSame(back->frame.image, thermal.image);
  EXPECT_FALSE(back->frame.valid);
}

TEST_P(RecordingTest, RigEventsPosesAndMetadataComeBack) {
  const StampedPose pose{
      .time = kScanStart + 2ms,
      .T_world_depth = MakeTransform({1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5))};
  {
    auto writer = WriterTo(disk_, options_);
    ASSERT_TRUE(writer->Write(MakeRig()).ok());
    ASSERT_TRUE(writer->WriteMetadata("origin", {{"folder", "scan"}}).ok());
    ASSERT_TRUE(writer->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
    ASSERT_TRUE(writer
                    ->Write(NucEvent{.start = kScanStart + 1ms,
                                     .end = kScanStart + 1600ms,
                                     .source = NucSource::kPolled})
                    .ok());
    ASSERT_TRUE(writer->Write(ClockStep{kScanStart + 2ms, -3s, -1s}).ok());
    ASSERT_TRUE(writer->WritePose("groundtruth", pose).ok());
    ASSERT_TRUE(writer->WriteLog(kScanStart + 3ms, "warning", "closer").ok());
  }
  const auto reader = Reader();
  const auto rig = reader->ReadRig();
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->depth->fx, 580);
  EXPECT_EQ(rig->thermal->p2, -2e-3);
  EXPECT_TRUE(rig->T_thermal_depth->isApprox(*MakeRig().T_thermal_depth, 1e-12));
  EXPECT_EQ(rig->thermal_delay_s, -0.0427);
  EXPECT_EQ(rig->serial, "A-7");

  const ReadBack read = ReadAll(*reader);
  const auto nuc = read.All<NucEvent>().at(0);
  EXPECT_EQ(nuc.start, kScanStart + 1ms);
  EXPECT_EQ(nuc.end, kScanStart + 1600ms);
  EXPECT_EQ(nuc.source, NucSource::kPolled);
  const auto step = read.All<ClockStep>().at(0);
  EXPECT_EQ(step.time, kScanStart + 2ms);
  EXPECT_EQ(step.step, -3s);
  EXPECT_EQ(step.wall_minus_time, -1s);
  const auto recorded = read.All<RecordedPose>().at(0);
  EXPECT_EQ(recorded.stream, "groundtruth");
  EXPECT_EQ(recorded.pose.time, pose.time);
  EXPECT_TRUE(recorded.pose.T_world_depth.isApprox(pose.T_world_depth, 1e-12));
  const auto log = read.All<RecordedLog>().at(0);
  EXPECT_EQ(log.time, kScanStart + 3ms);
  EXPECT_EQ(log.level, "warning");
  EXPECT_EQ(log.text, "closer");
  const RecordingInfo& info = reader->info();
  EXPECT_EQ(info.metadata.at("origin").at("folder"), "scan");
  EXPECT_EQ(info.messages_by_topic.at("/depth"), 1U);
  EXPECT_EQ(info.messages_by_topic.at("/log"), 1U);
  EXPECT_EQ(info.messages_by_topic.at("/depth/camera_info"), 1U);
  EXPECT_EQ(info.start, kScanStart);
  EXPECT_EQ(info.end, kScanStart + 3ms);
}

TEST_P(RecordingTest, ItemsComeInTheOrderOfTimeAndCanBeSought) {
  options_.flush_interval = 100ms;
  const auto scan = MakeScan(3000);
  {
    auto writer = WriterTo(disk_, options_);
    // Depth runs 40 ms behind thermal, as with a slow camera: chunks overlap.
    auto depth = scan.depth.begin();
    for (const auto& thermal : scan.thermal) {
      ASSERT_TRUE(writer->Write(thermal, std::nullopt).ok());
      while (depth != scan.depth.end() &&
             depth->header.capture_time + 40ms < thermal.header.capture_time) {
        ASSERT_TRUE(writer->Write(*depth++, std::nullopt).ok());
      }
    }
    while (depth != scan.depth.end()) ASSERT_TRUE(writer->Write(*depth++, std::nullopt).ok());
  }
  const auto reader = Reader();
  const ReadBack read = ReadAll(*reader);
  ASSERT_EQ(read.items.size(), scan.depth.size() + scan.thermal.size());
  EXPECT_TRUE(std::is_sorted(read.items.begin(), read.items.end(),
                             [](const auto& a, const auto& b) { return TimeOf(a) < TimeOf(b); }));
  const CaptureTime middle = kScanStart + 1510ms;
  ASSERT_TRUE(reader->Seek(middle).ok());
  const ReadBack later = ReadAll(*reader);
  const auto expected =
      std::count_if(read.items.begin(), read.items.end(),
                    [middle](const auto& item) { return TimeOf(item) >= middle; });
  EXPECT_EQ(later.items.size(), static_cast<std::size_t>(expected));
  EXPECT_GE(TimeOf(later.items.front()), middle);
}

INSTANTIATE_TEST_SUITE_P(Storage, RecordingTest,
                         ::testing::Values(ImageStorage::kViewable, ImageStorage::kCompact),
                         [](const auto& test) {
                           return test.param == ImageStorage::kViewable ? "Viewable" : "Compact";
                         });

/// An odometry source's word is evidence: it is kept as it came, right or wrong.
TEST(RecordingTest, OdometryPosesComeBackAsTheyWere) {
  ExternalOdometry pose;
  pose.source = "vio";
  pose.time = kScanStart + 7ms;
  pose.time_sigma = Nanoseconds(3000);
  pose.translation_m = {1.5, -2.0, std::numeric_limits<double>::quiet_NaN()};
  pose.rotation.coeffs() = Eigen::Vector4d(0.1, 0.2, 0.3, 2.0);
  pose.position_sigma_m = 0.01;
  pose.rotation_sigma_rad = 0.002;
  ExternalOdometry attitude;
  attitude.source = "imu";
  attitude.time = kScanStart + 8ms;
  attitude.position_sigma_m = ExternalOdometry::kNotMeasured;
  ExternalOdometry astray = attitude;
  astray.time = kScanStart + 1h;
  auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk);
  ASSERT_TRUE(writer->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
  ASSERT_TRUE(writer->Write(pose).ok());
  ASSERT_TRUE(writer->Write(attitude).ok());
  ASSERT_TRUE(writer->Write(astray).ok());
  ASSERT_TRUE(writer->Close().ok());
  auto reader = ReaderOf(disk->bytes);
  ASSERT_TRUE(reader.has_value());
  EXPECT_EQ((*reader)->info().messages_by_topic.at("/external_odometry"), 3U);
  const std::vector<ExternalOdometry> read = ReadAll(**reader).All<ExternalOdometry>();
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ((*reader)->info().end, attitude.time) << "a wrong stamp stretches nothing, ...";
  EXPECT_EQ(read[2].time, astray.time) << "... and is kept";
  EXPECT_EQ(read[0].source, "vio");
  EXPECT_EQ(read[0].time, pose.time);
  EXPECT_EQ(read[0].time_sigma, pose.time_sigma);
  EXPECT_EQ(read[0].translation_m.head<2>(), pose.translation_m.head<2>());
  EXPECT_TRUE(std::isnan(read[0].translation_m.z()));
  EXPECT_EQ(read[0].rotation.coeffs(), pose.rotation.coeffs());
  EXPECT_EQ(read[0].position_sigma_m, 0.01);
  EXPECT_EQ(read[0].rotation_sigma_rad, 0.002);
  EXPECT_FALSE(read[1].has_position());
  EXPECT_TRUE(std::isnan(read[1].rotation_sigma_rad));
}

/// Else whoever wrote it later than we were made would be read as centi-kelvin.
TEST(RecordingTest, ARawImageIsOfAKnownRawEncodingOrOfNoOneWhoSays) {
  const EncodedThermalFrame thermal = MakeThermal(8, kScanStart);
  auto message = recording::ToMessage<foxglove::RawImage>(thermal, std::nullopt);
  recording::SetImageData(EncodedImage(thermal.image), message);
  for (const int encoding : {3, 5, 7, 1000}) {
    foxglove::RawImage other = message;
    other.mutable_frame()->set_encoding(static_cast<std::uint32_t>(encoding));
    const auto read = recording::ToThermal(other, kScanStart, 0);
    ASSERT_FALSE(read.has_value()) << encoding;
    EXPECT_EQ(read.error().code(), StatusCode::kDataLoss);
    EXPECT_THAT(read.error().message(), HasSubstr(fmt::format("encoding {}", encoding)));
  }
  message.clear_frame();
  const auto read = recording::ToThermal(message, kScanStart, 0);
  ASSERT_TRUE(read.has_value());
  ExpectSame(read->frame.image, thermal.image);
  EXPECT_EQ(read->frame.scale, kCentikelvin);
}

/// As Foxglove's schema lists them.
TEST(RecordingTest, EachLensHasTheNameAndTheCoefficientsThatViewersKnow) {
  CameraModel camera{640, 480, 500.0, 501.0, 320.0, 240.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  const auto expect = [&](LensKind lens, const char* name, const std::vector<double>& values) {
    camera.lens = lens;
    const foxglove::CameraCalibration message = recording::ToMessage(kScanStart, "thermal", camera);
    EXPECT_EQ(message.distortion_model(), name);
    EXPECT_EQ(std::vector<double>(message.d().begin(), message.d().end()), values) << name;
  };
  expect(LensKind::kBrownConrady, "plumb_bob", {1.0, 2.0, 3.0, 4.0, 5.0});
  expect(LensKind::kRational, "rational_polynomial", {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  expect(LensKind::kFisheye, "kannala_brandt", {1.0, 2.0, 5.0, 6.0});
}

/// The channel had another name before.
TEST(RecordingTest, OdometryUnderItsOldNameIsStillRead) {
  ExternalOdometry pose;
  pose.source = "vio";
  pose.time = kScanStart + 7ms;
  const foxglove::PoseInFrame message = recording::ToMessage(pose);
  const auto& type = *foxglove::PoseInFrame::descriptor();
  auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk);
  ASSERT_TRUE(writer->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
  ASSERT_TRUE(writer
                  ->WriteMessage(recording::kOldOdometryTopic, type.full_name(),
                                 recording::SerializedSchema(type), pose.time,
                                 message.SerializeAsString())
                  .ok());
  ASSERT_TRUE(writer->Close().ok());
  auto reader = ReaderOf(disk->bytes);
  ASSERT_TRUE(reader.has_value());
  const std::vector<ExternalOdometry> read = ReadAll(**reader).All<ExternalOdometry>();
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].source, "vio");
  EXPECT_EQ(read[0].time, pose.time);
}

}  // namespace
}  // namespace isotherm
