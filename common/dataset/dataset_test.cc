#include "common/dataset/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <locale>

#include "common/dataset/image_file.h"
#include "common/dataset/testing/dataset_folder.h"
#include "common/dataset/text_lines.h"

namespace isotherm {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class DatasetTest : public testing::Test {
 protected:
  std::string Error() {
    const Result<Dataset> dataset = OpenDataset({folder_.path(), {}, {}});
    return dataset ? std::string("accepted") : dataset.error().message();
  }
  DatasetFolder folder_;
};

TEST_F(DatasetTest, CompleteFolderIsRead) {
  const Result<Dataset> dataset = OpenDataset({folder_.path(), {}, {}});
  ASSERT_TRUE(dataset) << dataset.error().message();
  EXPECT_EQ(dataset->depth.size(), 4U);
  EXPECT_EQ(dataset->thermal.size(), 6U);
  EXPECT_EQ(ToNanoseconds(dataset->depth[1].time), 100'133'000'000);
  EXPECT_EQ(dataset->depth[1].path, folder_.path() / "depth/1.png");
  ASSERT_EQ(dataset->nuc.size(), 1U);
  EXPECT_EQ(ToNanoseconds(dataset->nuc[0].end), 100'175'000'000);
  EXPECT_EQ(dataset->groundtruth.size(), 2U);
  EXPECT_EQ(dataset->rig.thermal_delay_s, -0.02);
  EXPECT_TRUE(dataset->notes.empty());
}

TEST_F(DatasetTest, WindowsLineEndingsByteOrderMarkAndBlankLinesAreFine) {
  folder_.Write("depth.txt",
                "\xef\xbb\xbf# c\r\n\r\n100.1   depth/0.png  \r\n\t100.2\tdepth/1.png");
  const Result<Dataset> dataset = OpenDataset({folder_.path(), {}, {}});
  ASSERT_TRUE(dataset) << dataset.error().message();
  EXPECT_EQ(dataset->depth.size(), 2U);
  EXPECT_EQ(dataset->depth[1].line, 4);
}

TEST_F(DatasetTest, AnotherThermalListIsTakenFromTheFolder) {
  folder_.Write("delayed.txt", "100.2 thermal/0.png\n");
  const Result<Dataset> dataset = OpenDataset({folder_.path(), "delayed.txt", {}});
  ASSERT_TRUE(dataset) << dataset.error().message();
  EXPECT_EQ(dataset->thermal.size(), 1U);
  const Result<Dataset> missing = OpenDataset({folder_.path(), "delaid.txt", {}});
  EXPECT_THAT(missing.error().message(), HasSubstr("Did you mean 'delayed.txt'?"));
}

TEST_F(DatasetTest, MissingOrMisspeltFolder) {
  const Result<Dataset> missing = OpenDataset({folder_.root() / "scna", {}, {}});
  EXPECT_EQ(missing.error().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.error().message(), AllOf(HasSubstr("no such folder"), HasSubstr("'scan'")));
  const Result<Dataset> file = OpenDataset({folder_.path() / "depth.txt", {}, {}});
  EXPECT_THAT(file.error().message(), HasSubstr("is not a folder"));
}

TEST_F(DatasetTest, EmptyFolderSaysWhatBelongsThere) {
  std::filesystem::create_directory(folder_.root() / "empty");
  const Result<Dataset> dataset = OpenDataset({folder_.root() / "empty", {}, {}});
  EXPECT_THAT(dataset.error().message(),
              AllOf(HasSubstr("the folder is empty"), HasSubstr("rig.textproto")));
}

TEST_F(DatasetTest, MissingRigGivesAnExampleAndASuggestion) {
  folder_.Rename("rig.textproto", "rig.textprot");
  EXPECT_THAT(Error(), AllOf(HasSubstr("no rig calibration"), HasSubstr("'rig.textprot'"),
                             HasSubstr("fx: 570")));
}

TEST_F(DatasetTest, F57RigWithoutIntrinsics) {
  folder_.Write("rig.textproto", "depth_scale: 1000\n");
  EXPECT_THAT(Error(), HasSubstr("neither depth nor thermal intrinsics"));
  folder_.Write("rig.textproto", "thermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt"), HasSubstr("no 'depth' intrinsics")));
  folder_.Write("rig.textproto", "depth { width: 32 height: 24 fx: 30 fy: 30 }\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("rig.textproto:1:1"), HasSubstr("'depth.cx' is missing")));
}

TEST_F(DatasetTest, AListThatIsTooLargeIsRefusedBeforeItIsRead) {
  std::filesystem::resize_file(folder_.path() / "depth.txt", kMaxTextFileBytes + 1);
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt"), HasSubstr("more than are read")));
}

TEST_F(DatasetTest, MissingOrMisspeltLists) {
  folder_.Rename("depth.txt", "dpeth.txt");
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt: no such file"), HasSubstr("'dpeth.txt'")));
  folder_.Rename("dpeth.txt", "depth.txt");
  folder_.Rename("thermal.txt", "termal.txt");
  EXPECT_THAT(Error(), HasSubstr("Did you mean 'termal.txt'?"));
  folder_.Remove("termal.txt");
  EXPECT_THAT(Error(), HasSubstr("there is a folder 'thermal'"));
  folder_.Remove("thermal");
  const Result<Dataset> dataset = OpenDataset({folder_.path(), {}, {}});
  ASSERT_TRUE(dataset) << dataset.error().message();
  EXPECT_THAT(dataset->notes.at(0), HasSubstr("no thermal frames"));
}

TEST_F(DatasetTest, MisspeltOptionalFileIsANote) {
  folder_.Rename("nuc.txt", "nucs.txt");
  const Result<Dataset> dataset = OpenDataset({folder_.path(), {}, {}});
  ASSERT_TRUE(dataset) << dataset.error().message();
  ASSERT_EQ(dataset->notes.size(), 1U);
  EXPECT_THAT(dataset->notes[0], AllOf(HasSubstr("'nucs.txt' is not read"), HasSubstr("nuc.txt")));
}

TEST_F(DatasetTest, ThermalWithoutDepthIsReadWithANote) {
  folder_.Write("rig.textproto", "thermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\n");
  folder_.Remove("depth.txt");
  folder_.Remove("depth");
  const Result<Dataset> dataset = OpenDataset({folder_.path(), {}, {}});
  ASSERT_TRUE(dataset) << dataset.error().message();
  EXPECT_TRUE(dataset->depth.empty());
  EXPECT_THAT(dataset->notes.back(), HasSubstr("not reconstructed"));
}

TEST_F(DatasetTest, MissingImageIsNamedWithItsLine) {
  folder_.Rename("depth/2.png", "depth/2.PNG");
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt:4: image"), HasSubstr("does not exist"),
                             HasSubstr("2.PNG")));
  folder_.Remove("depth");
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt:2"), HasSubstr("no folder")));
}

TEST_F(DatasetTest, UnsortedAndDuplicateStampsAreNamedWithBothLines) {
  folder_.Write("depth.txt", "# c\n2 depth/0.png\n1.5 depth/1.png\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt:3"), HasSubstr("is earlier than line 2"),
                             HasSubstr("sort")));
  folder_.Write("depth.txt", "2 depth/0.png\n2.000 depth/1.png\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt:2"), HasSubstr("duplicate of line 1")));
}

TEST_F(DatasetTest, StampsThatAreNoFiniteNumbers) {
  for (const std::string stamp :
       {"abc", "1,5", "nan", "inf", "-inf", "1e400", "1e12", "0x10", "1.2.3"}) {
    folder_.Write("depth.txt", "1 depth/0.png\n" + stamp + " depth/1.png\n");
    EXPECT_THAT(Error(), AllOf(HasSubstr("depth.txt:2: timestamp"), HasSubstr(stamp)));
  }
  folder_.Write("depth.txt", "1\n");
  EXPECT_THAT(Error(), HasSubstr("no file name"));
  folder_.Write("depth.txt", "# nothing\n\n");
  EXPECT_THAT(Error(), HasSubstr("has no frames"));
}

TEST_F(DatasetTest, BadNucIntervals) {
  folder_.Write("nuc.txt", "5\n");
  EXPECT_THAT(Error(), HasSubstr("nuc.txt:1: expected 'start_s end_s'"));
  folder_.Write("nuc.txt", "6 5\n");
  EXPECT_THAT(Error(), HasSubstr("before it starts"));
  folder_.Write("nuc.txt", "1 3\n2 4\n");
  EXPECT_THAT(Error(), HasSubstr("nuc.txt:2"));
  folder_.Write("nuc.txt", "1 soon\n");
  EXPECT_THAT(Error(), HasSubstr("'soon' is not a number"));
}

TEST_F(DatasetTest, BadGroundTruth) {
  folder_.Write("groundtruth.txt", "1 0 0 0 0 0 0\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("groundtruth.txt:1"), HasSubstr("8 columns")));
  folder_.Write("groundtruth.txt", "1 0 0 0 0 0 0 1 9\n");
  EXPECT_THAT(Error(), HasSubstr("8 columns"));
  folder_.Write("groundtruth.txt", "1 0 0 nan 0 0 0 1\n");
  EXPECT_THAT(Error(), HasSubstr("'nan' is not finite"));
  folder_.Write("groundtruth.txt", "1 0 0 0 0 0 0 2\n");
  EXPECT_THAT(Error(), HasSubstr("unit quaternion"));
  folder_.Write("groundtruth.txt", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  EXPECT_THAT(Error(), HasSubstr("groundtruth.txt:2"));
}

TEST(StampTest, IsExactToTheNanosecondForAnyEpoch) {
  EXPECT_EQ(ToNanoseconds(ParseStamp("1700000000.123456789").value()), 1'700'000'000'123'456'789);
  EXPECT_EQ(ToNanoseconds(ParseStamp("0.1").value()), 100'000'000);
  EXPECT_EQ(ToNanoseconds(ParseStamp("3").value()), 3'000'000'000);
  EXPECT_EQ(ToNanoseconds(ParseStamp("0.0000000019").value()), 2);
  EXPECT_EQ(ToNanoseconds(ParseStamp("1e-3").value()), 1'000'000);
  EXPECT_THAT(ParseStamp("-0.5").error().message(), HasSubstr("is negative"));
  EXPECT_EQ(FormatStamp(CaptureTimeFromNanoseconds(1'700'000'000'000'000'001)),
            "1700000000.000000001");
  EXPECT_EQ(FormatStamp(CaptureTimeFromNanoseconds(-500'000'000)), "-0.500000000");
}

TEST_F(DatasetTest, F65ListsThatLeadOutOfTheFolderAreRefusedWithTheirLine) {
  for (const std::string name : {"/etc/passwd", "../other/0.png", "depth/../../0.png", ".."}) {
    folder_.Write("depth.txt", "# images\n100.1 depth/0.png\n100.2 " + name + "\n");
    const auto dataset = OpenDataset({folder_.path(), {}, {}});
    ASSERT_FALSE(dataset) << name;
    EXPECT_THAT(dataset.error().message(),
                AllOf(HasSubstr("depth.txt:3: '" + name + "'"), HasSubstr("leads out of")));
  }
  folder_.Write("depth.txt", "100.1 ./depth/0.png\n100.2 depth/..1.png\n");
  folder_.Rename("depth/1.png", "depth/..1.png");
  EXPECT_TRUE(OpenDataset({folder_.path(), {}, {}}));
}

class ImageFileTest : public DatasetTest {
 protected:
  std::string ReadError(const std::string& name) {
    const auto image = ReadGrey16(folder_.path() / name, 32, 24);
    return image ? std::string("accepted") : image.error().message();
  }
};

TEST_F(ImageFileTest, ReadsEveryValue) {
  Image<std::uint16_t> pattern(32, 24);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 32; ++x) pattern.At(x, y) = static_cast<std::uint16_t>(y * 2700 + x);
  }
  pattern.At(31, 23) = 65535;
  folder_.WriteImage("all.png", pattern);
  const auto image = ReadGrey16(folder_.path() / "all.png", 32, 24);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image->At(5, 20), 54005);
  EXPECT_EQ(image->At(31, 23), 65535);
}

TEST_F(ImageFileTest, WrongSizeDepthOrChannelsAreSaid) {
  folder_.WriteImage("small.png", {16, 12, 1});
  EXPECT_THAT(ReadError("small.png"),
              AllOf(HasSubstr("16 x 12 pixels"), HasSubstr("says 32 x 24")));
  folder_.WriteOtherPng("eight.png", 32, 24, 1, 8);
  EXPECT_THAT(ReadError("eight.png"), HasSubstr("8 bits per pixel, expected 16"));
  folder_.WriteOtherPng("colour.png", 32, 24, 3, 16);
  EXPECT_THAT(ReadError("colour.png"), HasSubstr("3 channels"));
}

TEST_F(ImageFileTest, F65AFileThatIsTooLargeForAnImageIsRefusedBeforeItIsRead) {
  std::filesystem::resize_file(folder_.path() / "depth/0.png", (64U << 20U) + 1);
  EXPECT_THAT(ReadError("depth/0.png"), HasSubstr("more than are read"));
}

TEST_F(ImageFileTest, F65NoOtherFormatIsOpenedWhateverItsName) {
  // Other programs' files start like this: TIFF in both byte orders, JPEG, BMP, OpenEXR, PNM, GIF.
  for (const std::string& start :
       {std::string("II*\0\x08\0\0\0", 8), std::string("MM\0*\0\0\0\x08", 8),
        std::string("\xff\xd8\xff\xe0\0\x10JFIF", 10), std::string("BM"),
        std::string("\x76\x2f\x31\x01"), std::string("P5 32 24 65535\n"), std::string("GIF89a")}) {
    folder_.Write("image.png", start + std::string(4096, '\1'));
    EXPECT_THAT(ReadError("image.png"), HasSubstr("not a PNG"));
  }
}

TEST_F(ImageFileTest, F11DamagedImagesAreErrorsAtEveryLength) {
  std::ifstream file(folder_.path() / "depth/0.png", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    folder_.Write("cut.png", bytes.substr(0, length));
    EXPECT_NE(ReadError("cut.png"), "accepted") << length;
  }
  folder_.Write("text.png", "this is no image");
  EXPECT_THAT(ReadError("text.png"), HasSubstr("damaged or not a PNG"));
  EXPECT_THAT(ReadError("missing.png"), HasSubstr("cannot be opened"));
  std::string huge = bytes;  // Claims 2^31-1 pixels in width; must not be allocated.
  huge.replace(16, 4, "\x7f\xff\xff\xff");
  folder_.Write("huge.png", huge);
  EXPECT_THAT(ReadError("huge.png"), HasSubstr("2147483647 x 24"));
}

TEST(DatasetLocaleTest, F70FoldersOfAnyNameAreReadInAnyLocale) {
  class Comma final : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  std::locale::global(std::locale(std::locale(), new Comma));
  const bool c_locale = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  for (const std::string name : {"mit leer zeichen", "T\xc3\xbcr", "latin1-\xfc", "#1"}) {
    const DatasetFolder folder(name);
    folder.WriteImage("depth/mit leer.png", {32, 24, 1});
    folder.Write("depth.txt", "100.5 depth/mit leer.png\n");
    const Result<Dataset> dataset = OpenDataset({folder.path(), {}, {}});
    EXPECT_TRUE(dataset) << dataset.error().message();
    if (!dataset) continue;
    EXPECT_EQ(ToNanoseconds(dataset->depth[0].time), 100'500'000'000);
    EXPECT_EQ(dataset->rig.depth->cx, 15.5);
    EXPECT_TRUE(ReadGrey16(dataset->depth[0].path, 32, 24));
  }
  std::locale::global(std::locale::classic());
  std::setlocale(LC_ALL, "C");
  RecordProperty("german_c_locale", c_locale ? "used" : "not installed");
}

TEST(DatasetRealDataTest, ReadsTheReferenceFolders) {
  for (const auto& [name, depth, thermal] :
       {std::tuple{"furnace_dev", 300, 399}, std::tuple{"kinect_kitchen", 500, 0},
        std::tuple{"optris_desk", 0, 100}}) {
    const std::filesystem::path path = TestData(name);
    if (path.empty()) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
    const Result<Dataset> dataset = OpenDataset({path, {}, {}});
    ASSERT_TRUE(dataset) << dataset.error().message();
    EXPECT_EQ(dataset->depth.size(), static_cast<std::size_t>(depth)) << name;
    EXPECT_EQ(dataset->thermal.size(), static_cast<std::size_t>(thermal)) << name;
  }
}

}  // namespace
}  // namespace isotherm
