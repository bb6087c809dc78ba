#include "edge/nuc/nuc_need.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

NucObservation At(float housing_celsius, float fpa_celsius) {
  NucObservation seen;
  seen.housekeeping.housing_celsius = housing_celsius;
  seen.housekeeping.fpa_celsius = fpa_celsius;
  return seen;
}

class NucNeedTest : public testing::Test {
 protected:
  NucNeedTest() {
    options_.mutable_expert()->set_max_housing_drift_k(0.5);
    options_.mutable_expert()->set_max_fpa_drift_k(1);
    options_.set_max_interval_s(180);
  }
  NucNeed Make(bool is_ordered = true) {
    NucNeed need(options_, is_ordered, notices_);
    need.SetReference(At(30.0F, 35.0F).housekeeping);
    return need;
  }

  NucOptions options_;
  NucNotices notices_;
};

TEST_F(NucNeedTest, NothingIsNeededWhileTemperaturesStayAndTimeIsNotOver) {
  EXPECT_EQ(Make().Reason(At(30.4F, 34.1F), seconds(180)), "");
}

TEST_F(NucNeedTest, ADriftOfEitherTemperatureInEitherDirectionIsAReason) {
  const NucNeed need = Make();
  EXPECT_EQ(need.Reason(At(29.4F, 35.0F), seconds(1)),
            "the housing is -0.60 K off the last correction");
  EXPECT_EQ(need.Reason(At(30.0F, 36.1F), seconds(1)),
            "the detector is +1.10 K off the last correction");
}

TEST_F(NucNeedTest, ADriftCountsFromTheLastCorrection) {
  NucNeed need = Make();
  need.OnCorrected(At(33.0F, 38.0F).housekeeping);
  EXPECT_EQ(need.Reason(At(33.4F, 38.9F), seconds(1)), "");
  EXPECT_THAT(need.Reason(At(30.0F, 35.0F), seconds(1)), HasSubstr("the housing is -3.00 K"));
}

TEST_F(NucNeedTest, ATemperatureThatTheCameraDoesNotTellIsNoReason) {
  EXPECT_EQ(Make().Reason(At(kUnknown_celsius, kUnknown_celsius), seconds(1)), "");
}

TEST_F(NucNeedTest, ALimitOfZeroIsNone) {
  options_.mutable_expert()->set_max_housing_drift_k(0);
  options_.mutable_expert()->set_max_fpa_drift_k(0);
  options_.set_max_interval_s(0);
  EXPECT_EQ(Make().Reason(At(90.0F, 95.0F), std::chrono::hours(9)), "");
}

TEST_F(NucNeedTest, AnOldCorrectionIsAReason) {
  EXPECT_EQ(Make().Reason(At(30.0F, 35.0F), seconds(181)), "the last correction is 181 s old");
}

TEST_F(NucNeedTest, TheCamerasOwnWishIsAReason) {
  NucObservation seen = At(30.0F, 35.0F);
  seen.camera = CameraNuc{NucState::kDesired, NucSource::kInBand, std::nullopt};
  EXPECT_EQ(Make().Reason(seen, seconds(1)), "the camera asks for it");
}

TEST_F(NucNeedTest, BeforeTheScanOneIsNeededAndWaitedForUntilItWasSeen) {
  options_.set_before_scan(true);
  NucNeed need = Make();
  EXPECT_TRUE(need.WaitsForFirst());
  EXPECT_EQ(need.Reason(At(30.0F, 35.0F), seconds(1)), "start of the scan");
  need.OnCorrected(At(30.0F, 35.0F).housekeeping);
  EXPECT_FALSE(need.WaitsForFirst());
  EXPECT_EQ(need.Reason(At(30.0F, 35.0F), seconds(1)), "");
}

TEST_F(NucNeedTest, OneThatDoesNotComeIsWaivedAndSaidOnce) {
  options_.set_before_scan(true);
  NucNeed need = Make();
  need.OnGivenUp();
  need.OnGivenUp();
  EXPECT_FALSE(need.WaitsForFirst());
  EXPECT_THAT(notices_.Take(),
              ElementsAre(Field(&NucNotice::text, HasSubstr("the scan goes on without"))));
}

TEST_F(NucNeedTest, ARequiredOneIsNeverWaived) {
  options_.mutable_expert()->set_require_initial_nuc(true);
  NucNeed need = Make();
  need.OnGivenUp();
  EXPECT_TRUE(need.WaitsForFirst());
}

TEST_F(NucNeedTest, GivingUpALaterOneSaysNothingOfTheFirst) {
  options_.set_before_scan(true);
  NucNeed need = Make();
  need.OnCorrected(At(30.0F, 35.0F).housekeeping);
  need.OnGivenUp();
  EXPECT_THAT(notices_.Take(), IsEmpty());
}

TEST_F(NucNeedTest, ACameraThatWasAwayNeedsItsFirstAgain) {
  options_.set_before_scan(true);
  NucNeed need = Make();
  need.OnCorrected(At(30.0F, 35.0F).housekeeping);
  need.OnCameraAway();
  EXPECT_TRUE(need.WaitsForFirst());
}

TEST_F(NucNeedTest, ARecordingWaitsOnlyForWhatIsRequired) {
  options_.set_before_scan(true);
  EXPECT_FALSE(Make(false).WaitsForFirst());
  options_.mutable_expert()->set_require_initial_nuc(true);
  EXPECT_TRUE(Make(false).WaitsForFirst());
}

}  // namespace
}  // namespace isotherm
