#include "common/doubts/calibration_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/rig/rig_calibration.pb.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::chrono::sys_days kToday = std::chrono::year(2026) / 3 / 31;

RigCalibration OfDay(const std::string& date) {
  RigCalibration rig;
  rig.mutable_pose_calibration()->set_date(date);
  rig.mutable_pose_calibration()->set_uncertainty_px(0.2);
  return rig;
}

TEST(CalibrationDoubtsTest, WhatIsYoungAndCertainIsNotDoubted) {
  for (const char* date : {"2026-03-31", "2026-04-01", "2025-03-31", ""})
    EXPECT_THAT(DoubtsAboutRecords(OfDay(date), kToday, {}), IsEmpty()) << date;
}

TEST(CalibrationDoubtsTest, AgeIsSaidWithTheDayAndWhatToDo) {
  EXPECT_THAT(DoubtsAboutRecords(OfDay("2025-03-30"), kToday, {}),
              ElementsAre(AllOf(HasSubstr("pose between the cameras is 366 days old"),
                                HasSubstr("2025-03-30"), HasSubstr("calibrate check"))));
  EXPECT_THAT(DoubtsAboutRecords(OfDay("2024-01-01"), kToday, {.max_age_days = 0}), IsEmpty());
}

TEST(CalibrationDoubtsTest, ADayThatCannotBeIsSaid) {
  for (const char* date : {"2025-02-30", "31.3.2025", "2025-03-31 10:00", "soon"}) {
    EXPECT_THAT(DoubtsAboutRecords(OfDay(date), kToday, {}),
                ElementsAre(HasSubstr("its age is not known")))
        << date;
  }
  EXPECT_THAT(DoubtsAboutRecords(OfDay("2026-04-03"), kToday, {}),
              ElementsAre(HasSubstr("is this computer's clock right")));
}

TEST(CalibrationDoubtsTest, EachRecordCounts) {
  RigCalibration rig = OfDay("2026-01-01");
  rig.mutable_thermal_calibration()->set_uncertainty_px(0.7);
  rig.mutable_depth_calibration()->set_date("2020-01-01");
  EXPECT_THAT(DoubtsAboutRecords(rig, kToday, {}),
              ElementsAre(AllOf(HasSubstr("thermal camera's lens is uncertain by 0.70 px"),
                                HasSubstr("calibrate thermal")),
                          HasSubstr("depth camera's lens is 2281 days old")));
}

TEST(CalibrationDoubtsTest, WithoutRecordsTheFilesOwnDateCounts) {
  RigCalibration rig;
  rig.set_date("2020-01-01");
  // That of distances says nothing of where the cameras are.
  rig.mutable_depth_bias_calibration()->set_date("2026-03-01");
  EXPECT_THAT(DoubtsAboutRecords(rig, kToday, {}), ElementsAre(HasSubstr("the rig is 2281 days")));
  rig.mutable_radiometric_calibration()->set_date("2020-01-01");
  EXPECT_THAT(DoubtsAboutRecords(rig, kToday, {}),
              ElementsAre(HasSubstr("the rig is 2281 days"),
                          AllOf(HasSubstr("the thermal camera's readings"),
                                HasSubstr("calibrate radiometric"))));
  EXPECT_THAT(DoubtsAboutRecords(RigCalibration(), kToday, {}), IsEmpty());
}

}  // namespace
}  // namespace isotherm
