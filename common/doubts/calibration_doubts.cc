#include "common/doubts/calibration_doubts.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>

#include "common/rig/rig_calibration.pb.h"

namespace isotherm {
namespace {

/// The day of "2025-03-31"; nullopt for anything else.
std::optional<std::chrono::sys_days> DayOf(const std::string& date) {
  int year = 0;
  unsigned month = 0, day = 0;
  int read = 0;
  if (std::sscanf(date.c_str(), "%4d-%2u-%2u%n", &year, &month, &day, &read) != 3 ||
      read != static_cast<int>(date.size()))
    return std::nullopt;
  const std::chrono::year_month_day parsed{std::chrono::year(year), std::chrono::month(month),
                                           std::chrono::day(day)};
  if (!parsed.ok()) return std::nullopt;
  return std::chrono::sys_days(parsed);
}

/// Names what a record is about, and how it is found anew.
struct Part {
  const char* name;
  const char* remedy;
};

void AddAge(const Part& part, const std::string& date, std::chrono::sys_days today,
            const CalibrationLimits& limits, Doubts& doubts) {
  if (date.empty() || limits.max_age_days == 0) return;
  const std::optional<std::chrono::sys_days> day = DayOf(date);
  if (!day) {
    doubts.push_back(
        fmt::format("the calibration of {} is dated '{}', which is no day like 2025-03-31: its age "
                    "is not known",
                    part.name, date));
    return;
  }
  const auto age_days = (today - *day).count();
  if (age_days < -1) {
    doubts.push_back(fmt::format(
        "the calibration of {} is dated {}, which is yet to come: is this computer's clock right?",
        part.name, date));
  } else if (age_days > limits.max_age_days) {
    doubts.push_back(fmt::format(
        "the calibration of {} is {} days old (of {}; source.rig_max_age_days is {}): {}",
        part.name, age_days, date, limits.max_age_days, part.remedy));
  }
}

void AddUncertainty(const Part& part, const CalibrationRecord& record,
                    const CalibrationLimits& limits, Doubts& doubts) {
  if (!(record.uncertainty_px() > limits.uncertainty_px)) return;
  doubts.push_back(
      fmt::format("the calibration of {} is uncertain by {:.2f} px, more than {} px: {}", part.name,
                  record.uncertainty_px(), limits.uncertainty_px, part.remedy));
}

}  // namespace

Doubts DoubtsAboutRecords(const RigCalibration& rig, std::chrono::sys_days today,
                          const CalibrationLimits& limits) {
  constexpr Part kThermal{"the thermal camera's lens",
                          "calibrate it again, `isotherm calibrate thermal`"};
  constexpr Part kDepth{"the depth camera's lens",
                        "calibrate it again, `isotherm calibrate depth`"};
  constexpr Part kPose{"the pose between the cameras",
                       "see whether it still fits, `isotherm calibrate check RECORDING`"};
  constexpr Part kDepthBias{"the depth camera's distances",
                            "calibrate them again, `isotherm calibrate depth-bias`"};
  constexpr Part kReadings{"the thermal camera's readings",
                           "calibrate them again, `isotherm calibrate radiometric`"};
  constexpr Part kAll{"the rig", "see whether it still fits, `isotherm calibrate check RECORDING`"};
  Doubts doubts;
  bool has_records = false;
  const auto add = [&](const Part& part, bool has, const CalibrationRecord& record) {
    if (!has) return;
    has_records = has_records || !record.date().empty();
    AddAge(part, record.date(), today, limits, doubts);
    AddUncertainty(part, record, limits, doubts);
  };
  add(kThermal, rig.has_thermal_calibration(), rig.thermal_calibration());
  add(kDepth, rig.has_depth_calibration(), rig.depth_calibration());
  add(kPose, rig.has_pose_calibration(), rig.pose_calibration());
  if (!has_records) AddAge(kAll, rig.date(), today, limits, doubts);
  add(kDepthBias, rig.has_depth_bias_calibration(), rig.depth_bias_calibration());
  add(kReadings, rig.has_radiometric_calibration(), rig.radiometric_calibration());
  return doubts;
}

}  // namespace isotherm
