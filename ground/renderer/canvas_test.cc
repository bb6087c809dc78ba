// The canvas is compared with OpenCV, which draws the same letters and shapes in its own way.

#include "ground/renderer/canvas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <vector>

namespace isotherm {
namespace {

constexpr Rgb8 kWhite{255, 255, 255};
constexpr int kSide = 120;
constexpr int kLetter_px = 42;
constexpr double kBlur_px = 2.0;
/// Height of a capital letter of OpenCV's simplex font at scale 1, pixels.
constexpr double kCapitalOfOpenCv_px = 21.0;

cv::Mat Channel(const RgbImage& rendering) {
  cv::Mat grey(rendering.height(), rendering.width(), CV_8U);
  for (int y = 0; y < rendering.height(); ++y) {
    for (int x = 0; x < rendering.width(); ++x) grey.at<std::uint8_t>(y, x) = rendering.At(x, y).r;
  }
  return grey;
}

/// A letter as two shapes can be compared: at its height, but of one width and one place from left
/// to right, blurred so that small differences of form do not count; mean 0, length 1.
cv::Mat Comparable(const cv::Mat& grey) {
  constexpr int kNarrow_px = 14;
  constexpr int kWidth_px = 32;
  const cv::Rect box = cv::boundingRect(grey);
  const int width = box.width < kNarrow_px ? box.width : kWidth_px;
  cv::Mat stretched;
  cv::resize(grey.colRange(box.x, box.x + box.width), stretched, {width, kSide}, 0, 0,
             cv::INTER_AREA);
  cv::Mat shape = cv::Mat::zeros(kSide, kSide, CV_64F);
  stretched.convertTo(shape.colRange((kSide - width) / 2, (kSide - width) / 2 + width), CV_64F);
  cv::GaussianBlur(shape, shape, {}, kBlur_px);
  shape -= cv::mean(shape);
  return shape / cv::norm(shape);
}

cv::Mat Ours(char letter) {
  RgbImage rendering(kSide, kSide);
  Canvas(rendering).Text(30, kSide / 2.0, std::string(1, letter), kLetter_px, kWhite);
  return Comparable(Channel(rendering));
}

cv::Mat OfOpenCv(char letter) {
  cv::Mat grey = cv::Mat::zeros(kSide, kSide, CV_8U);
  cv::putText(grey, std::string(1, letter), {30, kSide / 2 + kLetter_px / 2},
              cv::FONT_HERSHEY_SIMPLEX, kLetter_px / kCapitalOfOpenCv_px, cv::Scalar(255), 5,
              cv::LINE_AA);
  return Comparable(grey);
}

TEST(CanvasTest, EachLetterIsNearestToOpenCvsSameLetter) {
  // Not those that OpenCV draws otherwise: its 3 has a flat top, and its l no foot.
  const std::string drawn =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijkmnopqrstuvwxyz012456789%()+,-./:<=>?[]";
  std::vector<cv::Mat> theirs;
  for (const char letter : drawn) theirs.push_back(OfOpenCv(letter));
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const cv::Mat ours = Ours(drawn[k]);
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < theirs.size(); ++i) {
      if (ours.dot(theirs[i]) > ours.dot(theirs[nearest])) nearest = i;
    }
    const bool is_same_shape = std::set{drawn[k], drawn[nearest]} == std::set{'0', 'O'};
    EXPECT_TRUE(nearest == k || is_same_shape)
        << drawn[k] << " looks like " << drawn[nearest] << ", by " << ours.dot(theirs[nearest])
        << " against " << ours.dot(theirs[k]);
  }
}

TEST(CanvasTest, ALetterIsAsHighAndAsHeavyAsAskedFor) {
  for (const double height : {9.0, 24.0, 60.0}) {
    RgbImage rendering(200, 200);
    Canvas(rendering).Text(40, 100, "H", height, kWhite);
    const cv::Mat grey = Channel(rendering);
    // The strokes' round ends stand over by half a stroke.
    EXPECT_NEAR(cv::boundingRect(grey > 127).height, 1.125 * height, 1.5) << height;
    // Two stems and a bar of 13/18, less where they meet.
    const double ink = cv::sum(grey)[0] / 255.0;
    EXPECT_NEAR(ink, (2.0 + 13.0 / 18.0) * 0.125 * height * height, 0.06 * height * height)
        << height;
  }
}

TEST(CanvasTest, TextStandsWhereItsWidthAndAlignmentSay) {
  const std::string text = "12.5 °C";
  const double width = TextWidth(text, 20.0);
  for (const auto& [align, left] :
       {std::pair{TextAlign::kLeft, 150.0}, std::pair{TextAlign::kCentre, 150.0 - width / 2},
        std::pair{TextAlign::kRight, 150.0 - width}}) {
    RgbImage rendering(300, 60);
    Canvas(rendering).Text(150, 30, text, 20.0, kWhite, align);
    const cv::Rect box = cv::boundingRect(Channel(rendering));
    EXPECT_GE(box.x, left - 1.0);
    EXPECT_LE(box.x + box.width, left + width + 1.0);
    EXPECT_GT(box.width, 0.8 * width);
  }
  EXPECT_DOUBLE_EQ(TextWidth("ab", 20.0), TextWidth("a", 20.0) + TextWidth("b", 20.0));
}

TEST(CanvasTest, OutsideOfTheImageNothingIsDrawnAndUnknownLettersAreQuestionMarks) {
  RgbImage rendering(20, 10);
  Canvas canvas(rendering);
  canvas.Text(-15, 0, "clipped on each side", 14, kWhite, TextAlign::kCentre);
  canvas.Text(1000, 1000, "far away", 14, kWhite);
  canvas.FillTriangle({-5, -5}, {50, 5}, {3, 40}, kWhite);
  EXPECT_EQ(TextWidth("\u00E4\u20AC\x01\xFF", 10.0), TextWidth("????", 10.0));
}

TEST(CanvasTest, ATriangleIsOpenCvsTriangle) {
  constexpr int kFactor = 16;  // OpenCV draws it larger, and it is averaged down.
  const cv::Point2d corners[][3] = {{{10.0, 50.0}, {61.5, 42.0}, {35.25, 8.0}},
                                    {{10.0, 8.0}, {35.0, 50.0}, {61.0, 8.0}},
                                    {{20.0, 20.0}, {20.0, 44.0}, {50.0, 32.0}}};
  for (const auto& [a, b, c] : corners) {
    RgbImage rendering(72, 60);
    Canvas(rendering).FillTriangle({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, kWhite);
    cv::Mat large = cv::Mat::zeros(60 * kFactor, 72 * kFactor, CV_8U);
    const std::vector<cv::Point> points = {a * kFactor, b * kFactor, c * kFactor};
    cv::fillConvexPoly(large, points, cv::Scalar(255));
    cv::Mat expected;
    cv::resize(large, expected, {72, 60}, 0, 0, cv::INTER_AREA);
    cv::Mat difference;
    cv::absdiff(Channel(rendering), expected, difference);
    EXPECT_LT(cv::mean(difference)[0], 0.6);
    double worst = 0.0;
    cv::minMaxLoc(difference, nullptr, &worst);
    EXPECT_LT(worst, 64.0) << "beyond what a corner's pixel may differ";
  }
}

}  // namespace
}  // namespace isotherm
