#include "common/dataset/import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <random>

#include "common/codec/codec.h"
#include "common/dataset/image_file.h"
#include "common/dataset/testing/dataset_folder.h"

namespace isotherm {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Content {
  std::vector<RecordedDepth> depth;
  std::vector<RecordedThermal> thermal;
  std::vector<NucEvent> events;
  std::vector<RecordedPose> poses;
  std::vector<ExternalOdometry> external_odometry;
  std::vector<CaptureTime> order;
};

Content ReadBack(RecordingReader& reader) {
  Content content;
  for (;;) {
    auto item = reader.Next();
    EXPECT_TRUE(item) << item.error().message();
    if (!item || !*item) return content;
    if (auto* depth = std::get_if<RecordedDepth>(&**item)) {
      content.order.push_back(depth->frame.header.capture_time);
      content.depth.push_back(std::move(*depth));
    } else if (auto* thermal = std::get_if<RecordedThermal>(&**item)) {
      content.order.push_back(thermal->frame.header.capture_time);
      content.thermal.push_back(std::move(*thermal));
    } else if (auto* event = std::get_if<NucEvent>(&**item)) {
      content.events.push_back(*event);
    } else if (auto* odometry = std::get_if<ExternalOdometry>(&**item)) {
      content.order.push_back(odometry->time);
      content.external_odometry.push_back(std::move(*odometry));
    } else {
      content.poses.push_back(std::get<RecordedPose>(**item));
    }
  }
}

class ImportTest : public testing::Test {
 protected:
  ImportTest() {
    request_.dataset.folder = folder_.path();
    request_.recording = folder_.root() / "scan.mcap";
    request_.software = "test";
  }
  std::string Error() {
    const auto summary = ImportDataset(request_);
    return summary ? std::string("accepted") : summary.error().message();
  }
  // Everything beside the dataset folder.
  std::vector<std::string> Outputs() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.root())) {
      if (entry.path() != folder_.path()) names.push_back(entry.path().filename().string());
    }
    return names;
  }
  DatasetFolder folder_;
  ImportRequest request_;
};

TEST_F(ImportTest, RecordingHasWhatTheFolderHad) {
  for (const ImageStorage storage : {ImageStorage::kCompact, ImageStorage::kViewable}) {
    request_.storage = storage;
    request_.overwrite = true;
    const auto summary = ImportDataset(request_);
    ASSERT_TRUE(summary) << summary.error().message();
    EXPECT_EQ(summary->depth_frames, 4U);
    EXPECT_EQ(summary->thermal_frames, 6U);
    EXPECT_EQ(summary->thermal_frames_in_nuc, 2U);
    EXPECT_EQ(summary->groundtruth_poses, 2U);
    auto reader = RecordingReader::Open(request_.recording);
    ASSERT_TRUE(reader) << reader.error().message();
    EXPECT_TRUE((*reader)->info().complete);
    const Result<Rig> rig = (*reader)->ReadRig();
    ASSERT_TRUE(rig) << rig.error().message();
    EXPECT_EQ(rig->thermal_delay_s, -0.02);
    const Content content = ReadBack(**reader);
    EXPECT_TRUE(std::is_sorted(content.order.begin(), content.order.end()));
    ASSERT_EQ(content.depth.size(), 4U);
    EXPECT_EQ(content.depth[2].frame.header.frame_number, 2U);
    EXPECT_EQ(ToNanoseconds(content.depth[2].frame.header.capture_time), 100'166'000'000);
    EXPECT_EQ(content.depth[2].frame.depth_scale, 1000.0);
    const auto image = Decode(content.depth[2].frame.image);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(*image, *ReadGrey16(folder_.path() / "depth/2.png", 32, 24));
    EXPECT_EQ(Decode(content.thermal[5].frame.image)->At(0, 0), 30005);
    ASSERT_EQ(content.poses.size(), 2U);
    EXPECT_EQ(content.poses[1].stream, "groundtruth");
    EXPECT_NEAR(content.poses[1].pose.T_world_depth.translation().x(), 0.01, 1e-12);
    EXPECT_EQ(content.events.size(), 1U);
  }
}

TEST_F(ImportTest, ThermalImagesHaveTheScaleOfTheRigFile) {
  folder_.Write("rig.textproto",
                "thermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\n"
                "depth { width: 32 height: 24 fx: 30 fy: 30 cx: 15.5 cy: 11.5 }\n"
                "thermal_scale: 0.02\nthermal_offset: 5\n");
  for (const ImageStorage storage : {ImageStorage::kCompact, ImageStorage::kViewable}) {
    request_.storage = storage;
    request_.overwrite = true;
    ASSERT_EQ(Error(), "accepted");
    auto reader = RecordingReader::Open(request_.recording);
    ASSERT_TRUE(reader.has_value());
    EXPECT_EQ((*reader)->ReadRig()->thermal_scale, (RadiometricScale{0.02, 5.0}));
    const Content content = ReadBack(**reader);
    ASSERT_EQ(content.thermal.size(), 6U);
    const EncodedThermalFrame& frame = content.thermal[5].frame;
    EXPECT_TRUE(IsScaled(frame.image.encoding));
    const std::uint16_t raw = DecodeTemperatures(frame.image)->At(0, 0);
    EXPECT_NEAR(frame.scale.Celsius(raw), 0.02 * 30'005 + 5.0 - 273.15, 1e-3);
  }
}

TEST_F(ImportTest, AThermalScaleThatCannotBeIsRefusedWithFileAndField) {
  folder_.Write("rig.textproto",
                "thermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\nthermal_scale: 0\n");
  const std::string error = Error();
  EXPECT_NE(error.find("rig.textproto"), std::string::npos) << error;
  EXPECT_NE(error.find("thermal_scale"), std::string::npos) << error;
}

TEST_F(ImportTest, OdometryPosesComeAlongInOrderOfTime) {
  folder_.Write(
      "vio.txt",
      "# any reference frame\n100.090 5 6 7 0 0 0 1\n100.120 5.01 6 7 0 0 0.1 0.99498744\n"
      "100.150 5.02 6 7 0 0 0 1\n");
  request_.dataset.external_odometry = "vio.txt";
  const auto summary = ImportDataset(request_);
  ASSERT_TRUE(summary) << summary.error().message();
  EXPECT_EQ(summary->external_odometry, 3U);
  const Content content = ReadBack(**RecordingReader::Open(request_.recording));
  EXPECT_TRUE(std::is_sorted(content.order.begin(), content.order.end()));
  ASSERT_EQ(content.external_odometry.size(), 3U);
  const ExternalOdometry& pose = content.external_odometry[1];
  EXPECT_EQ(pose.source, "vio");
  EXPECT_EQ(ToNanoseconds(pose.time), 100'120'000'000);
  EXPECT_NEAR(pose.translation_m.x(), 5.01, 1e-12);
  EXPECT_NEAR(pose.rotation.z(), 0.1, 1e-6);
  EXPECT_TRUE(std::isnan(pose.position_sigma_m)) << "a trajectory file does not say";
}

TEST_F(ImportTest, BadOdometryPosesNameTheirFileAndLine) {
  request_.dataset.external_odometry = "vio.txt";
  EXPECT_THAT(Error(), HasSubstr("vio.txt"));
  folder_.Write("vio.txt", "100.1 0 0 0 0 0 0 1\n100.2 0 0 0 0 0 0 2\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("vio.txt:2"), HasSubstr("unit quaternion")));
}

TEST_F(ImportTest, FramesInsideNucIntervalsStayButAreInvalid) {
  ASSERT_TRUE(ImportDataset(request_));
  const Content content = ReadBack(**RecordingReader::Open(request_.recording));
  std::vector<bool> valid;
  for (const RecordedThermal& thermal : content.thermal) {
    valid.push_back(thermal.frame.valid);
    EXPECT_EQ(thermal.frame.nuc_state == NucState::kInProgress, !thermal.frame.valid);
  }
  EXPECT_THAT(valid, testing::ElementsAre(true, true, false, false, true, true));
  EXPECT_FALSE(content.thermal[0].frame.seconds_since_nuc);
  EXPECT_NEAR(content.thermal[5].frame.seconds_since_nuc.value(), 0.050, 1e-9);
}

TEST(NucMarkerTest, RepeatsOfAFrozenImageBehindTheIntervalAreInvalidToo) {
  const auto time = [](int ms) { return CaptureTime(std::chrono::milliseconds(ms)); };
  NucMarker marker({{time(100), time(150)}});
  const auto valid = [&](int ms, std::uint16_t value) {
    ThermalFrame frame;
    frame.header.capture_time = time(ms);
    frame.temperature_raw = Image<std::uint16_t>(2, 2, value);
    marker.Mark(frame);
    return frame.valid;
  };
  EXPECT_TRUE(valid(80, 7));
  EXPECT_TRUE(valid(90, 7));    // A repeat before the interval is no shutter.
  EXPECT_FALSE(valid(100, 7));  // Both ends are inside.
  EXPECT_FALSE(valid(150, 7));
  EXPECT_FALSE(valid(160, 7));
  EXPECT_FALSE(valid(170, 7));
  EXPECT_TRUE(valid(180, 8));
  EXPECT_TRUE(valid(190, 8));
}

TEST_F(ImportTest, BadImageEndsItWithItsPlaceAndLeavesNothing) {
  folder_.WriteOtherPng("depth/2.png", 32, 24, 1, 8);
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt:4"), HasSubstr("2.png"), HasSubstr("8 bits"),
                             HasSubstr("--skip-bad")));
  EXPECT_TRUE(Outputs().empty());
}

TEST_F(ImportTest, SkipBadLeavesBadImagesOutAndCountsThem) {
  folder_.WriteOtherPng("depth/2.png", 32, 24, 1, 8);
  folder_.Write("thermal/0.png", "no image");
  request_.skip_bad = true;
  const auto summary = ImportDataset(request_);
  ASSERT_TRUE(summary) << summary.error().message();
  EXPECT_EQ(summary->skipped_images, 2U);
  EXPECT_EQ(summary->depth_frames, 3U);
  EXPECT_EQ(summary->notes.size(), 2U);
  const Content content = ReadBack(**RecordingReader::Open(request_.recording));
  ASSERT_EQ(content.depth.size(), 3U);
  EXPECT_EQ(content.depth[2].frame.header.frame_number, 3U);  // The hole stays visible.
}

TEST_F(ImportTest, AnExistingFileIsKeptUnlessForcedAndEvenThenUntilTheNewOneIsComplete) {
  std::ofstream(request_.recording) << "precious";
  EXPECT_THAT(Error(), AllOf(HasSubstr("exists already"), HasSubstr("--force")));
  request_.overwrite = true;
  folder_.Write("depth/3.png", "broken");
  EXPECT_THAT(Error(), HasSubstr("3.png"));
  std::ifstream file(request_.recording);
  std::string text;
  std::getline(file, text);
  EXPECT_EQ(text, "precious");
  EXPECT_EQ(Outputs().size(), 1U);
  request_.skip_bad = true;
  EXPECT_TRUE(ImportDataset(request_));
  EXPECT_EQ(Outputs().size(), 1U);
  EXPECT_TRUE(RecordingReader::Open(request_.recording));
}

TEST_F(ImportTest, DevicesAndFoldersAreNoPlaceForARecording) {
  request_.overwrite = true;
  request_.recording = "/dev/full";
  EXPECT_THAT(Error(), HasSubstr("not a regular file"));
  request_.recording = folder_.root();
  EXPECT_THAT(Error(), HasSubstr("not a regular file"));
  request_.recording = folder_.path() / "depth.txt" / "scan.mcap";
  EXPECT_NE(Error(), "accepted");
}

TEST_F(ImportTest, FullDiskIsSaidAndLeavesNothing) {
  Image<std::uint16_t> noise(32, 24);
  std::mt19937 random(1);
  for (std::uint16_t& pixel : noise.pixels()) pixel = static_cast<std::uint16_t>(random());
  for (int i = 0; i < 4; ++i) folder_.WriteImage("depth/" + std::to_string(i) + ".png", noise);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit small{.rlim_cur = 4096, .rlim_max = old_limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto summary = ImportDataset(request_);
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code(), StatusCode::kResourceExhausted) << summary.error().message();
  EXPECT_TRUE(Outputs().empty());
}

TEST_F(ImportTest, ProgressRisesToTheEnd) {
  std::vector<double> fractions;
  request_.progress = [&](double fraction) { fractions.push_back(fraction); };
  ASSERT_TRUE(ImportDataset(request_));
  EXPECT_EQ(fractions.size(), 10U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

}  // namespace
}  // namespace isotherm
