#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "common/base/output_file.h"
#include "common/base/progress.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "ground/cli/calibrated_rig_file.h"
#include "ground/cli/command.h"
#include "ground/cli/radiometric_html.h"
#include "ground/cli/today.h"
#include "ground/json/json.h"

namespace isotherm {
namespace {

constexpr const char* kRadiometricFooter =
    R"(Finds by what the thermal camera's readings have to be raised to be right, from black bodies of known
temperature, and what the radiation on other pixels adds to each one (the scene's influence: up to 7 K).

TABLE has one row per comparison: the black body's temperature in °C, what the camera shows of it, and, if it
is known, the standard uncertainty of that temperature in K. What the camera shows is a reading in °C (taken
with an emissivity of 1, of a black body that fills the image), or a file with images of it: a recording, a
PNG file or a folder of them, relative to the table. The camera rests; half a minute after a NUC is best.

  # black body, reading or images, uncertainty
  30, 29.6, 0.2
  60, 59.1, 0.2
  120, hole-10mm.mcap
  120, hole-30mm.mcap
  120, hole-70mm.mcap

For the scene's influence (thesis 5.1.3): put plates of cardboard with one round hole before the black body,
three or more, the largest with twice the radius of the smallest or more, in front of a sharply focused camera,
so that the image shows nothing but the plate and the black body behind the hole. Two seconds for each, before
the plate becomes warm, all at one temperature of the black body; 100 °C or more over the plate's tells most.

With --warm-up it finds how readings drift after a NUC as the camera's housing warms up, for cameras that tell
its temperature: record a camera that rests before anything of constant temperature, from switching it on, for
half an hour, with a NUC every few minutes.

Without --apply or --output nothing is written. What was found replaces the calibration's
thermal_sensor.radiometric_correction, scene_influence and housing_drift, and only what was found; comments of
the file are lost, and as it was it is kept beside it (FILE.bak). The ground corrects each thermal image by it
before it is fused; recordings stay as measured.

Examples:
  isotherm calibrate radiometric black-body.csv --rig rig.textproto
  isotherm calibrate radiometric black-body.csv --rig rig.textproto --emissivity 0.95 --apply
  isotherm calibrate radiometric --warm-up warm-up.mcap --rig rig.textproto --apply)";

struct RadiometricArguments {
  std::string table, warm_up, rig, output, json, html;
  RadiometricConditions conditions;
  bool apply = false;
};

std::string RowText(const RowReport& row) {
  std::string seen = "told";
  if (row.frames > 0 && row.hole_radius_px > 0.0) {
    seen = fmt::format("{} frames, hole of {:.0f} px", row.frames, row.hole_radius_px);
  } else if (row.frames > 0) {
    seen = fmt::format("{} frames", row.frames);
  }
  return fmt::format("{:>9.1f} °C{:>10.2f} °C{:>10.2f} °C{:>10.2f} °C{:>+9.2f} K   {}\n",
                     row.row.body_celsius, row.apparent_celsius, row.measured_celsius,
                     row.own_celsius, row.left_k, seen);
}

std::string InfluenceText(const RadiometricReport& report) {
  const auto percent = [](double fraction, double sigma) {
    return fmt::format("{:.2f} +- {:.2f} %", 100.0 * fraction, 100.0 * sigma);
  };
  if (!report.why_no_influence.empty())
    return fmt::format("the scene's influence is not told: {}\n", report.why_no_influence);
  if (!report.influence) return "";
  const InfluenceReport& found = *report.influence;
  return fmt::format(
      "the scene's influence: {} of what is around a pixel within {:.1f} +- {:.1f} px (one sigma), "
      "{} of the whole image\n"
      "holes that were left out read {:.2f} K apart as measured, {:.2f} K corrected\n",
      percent(found.influence.near_fraction, found.Sigma(0)), found.influence.near_sigma_px,
      found.Sigma(1), percent(found.influence.total_fraction, found.Sigma(2)), found.apart_before_k,
      found.apart_after_k);
}

std::string CurveText(const RadiometricReport& report) {
  constexpr const char* kShapes[] = {"the same for all readings", "a line", "a parabola"};
  const CurveReport& curve = report.curve;
  std::string text = fmt::format("correction of readings, {}:\n", kShapes[curve.degree]);
  const RadiometricCorrection& table = curve.correction;
  for (std::size_t i = 0; i < table.readings_celsius.size(); i += 2) {
    text += fmt::format("{:>9.1f} °C{:>+9.2f} +- {:.2f} K\n", table.readings_celsius[i],
                        table.corrections_k[i], table.sigmas_k[i]);
  }
  text += "colder and hotter readings are corrected as the nearest of these\n";
  text += fmt::format("readings by themselves are wrong by {:.2f} K", curve.before_k);
  if (!std::isnan(curve.held_out_k))
    text += fmt::format(", by {:.2f} K corrected by what the other temperatures tell",
                        curve.held_out_k);
  text += " (root mean square)\n";
  if (curve.degree == 0 && report.temperatures < 3)
    text += "a line takes three temperatures of the black body\n";
  if (!curve.IsKnown()) {
    text += "what is corrected predicts nothing: the correction is not written\n";
  } else if (report.IsRightAsItIs()) {
    text += "readings are right within twice the uncertainty, that of the black body included\n";
  }
  return text;
}

std::string DriftText(const DriftReport& report) {
  std::string text = fmt::format(
      "housing: {} frames in {} parts between NUCs, in which it changes by up to {:.2f} K\n"
      "readings are too high by {:+.2f} +- {:.2f} K for each kelvin that it is warmer than at the "
      "NUC\n"
      "readings stray by {:.3f} K as measured, by {:.3f} K corrected by what the other parts "
      "tell\n",
      report.frames, report.epochs, report.most_change_k, report.drift.error_per_kelvin,
      report.drift.sigma, report.before_k, report.held_out_k);
  if (!report.IsKnown()) text += "that is not less than half: it is not written\n";
  return text;
}

std::string ReportText(const RadiometricConditions& conditions, const RadiometricReport& report) {
  std::string text = fmt::format(
      "black body: emissivity {:g} +- {:g}, reflects {:g} +- {:g} °C, its temperatures are "
      "uncertain by {:g} K together (--emissivity, --emissivity-sigma, --reflected, "
      "--reflected-sigma, --calibrator-sigma)\n",
      conditions.emissivity, conditions.emissivity_sigma, conditions.reflected_celsius,
      conditions.reflected_sigma_k, conditions.common_sigma_k);
  text += fmt::format("{:>12}{:>13}{:>13}{:>13}{:>11}\n", "black body", "should read", "reads",
                      "by itself", "left");
  for (const RowReport& row : report.rows) text += RowText(row);
  text += InfluenceText(report);
  if (report.influence && report.influence->IsKnown())
    text += "\"by itself\" is without what the rest of the scene adds\n";
  return text + CurveText(report);
}

Json InfluenceJson(const InfluenceReport& found) {
  Json json;
  json["near_fraction"] = found.influence.near_fraction;
  json["near_fraction_sigma"] = found.Sigma(0);
  json["near_sigma_px"] = found.influence.near_sigma_px;
  json["near_sigma_px_sigma"] = found.Sigma(1);
  json["total_fraction"] = found.influence.total_fraction;
  json["total_fraction_sigma"] = found.Sigma(2);
  json["apart_before_k"] = found.apart_before_k;
  json["apart_after_k"] = found.apart_after_k;
  json["known"] = found.IsKnown();
  return json;
}

void AppendReadings(const RadiometricReport& report, Json& json) {
  for (const RowReport& row : report.rows) {
    Json each;
    each["black_body_celsius"] = row.row.body_celsius;
    each["apparent_celsius"] = row.apparent_celsius;
    each["measured_celsius"] = row.measured_celsius;
    each["own_celsius"] = row.own_celsius;
    each["left_k"] = row.left_k;
    each["frames"] = row.frames;
    each["hole_radius_px"] = row.hole_radius_px;
    json["rows"].push_back(std::move(each));
  }
  if (report.influence) json["scene_influence"] = InfluenceJson(*report.influence);
  json["degree"] = report.curve.degree;
  json["before_k"] = report.curve.before_k;
  // One temperature tells nothing of others.
  if (!std::isnan(report.curve.held_out_k)) json["held_out_k"] = report.curve.held_out_k;
  json["reading_celsius"] = report.curve.correction.readings_celsius;
  json["correction_k"] = report.curve.correction.corrections_k;
  json["sigma_k"] = report.curve.correction.sigmas_k;
}

Json ReportJson(const RadiometricFindings& found) {
  Json json;
  if (found.readings) AppendReadings(*found.readings, json);
  if (!found.drift) return json;
  Json& drift = json["housing_drift"];
  drift["error_per_kelvin"] = found.drift->drift.error_per_kelvin;
  drift["sigma"] = found.drift->drift.sigma;
  drift["epochs"] = found.drift->epochs;
  drift["most_change_k"] = found.drift->most_change_k;
  drift["before_k"] = found.drift->before_k;
  drift["held_out_k"] = found.drift->held_out_k;
  drift["known"] = found.drift->IsKnown();
  return json;
}

/// Sets what was found, and how, in the record.
void SetReadings(const RadiometricReport& report, CalibrationRecord& record,
                 ThermalSensorProperties& sensor) {
  ThermalSensorModel found;
  found.radiometric_correction = report.curve.correction;
  found.scene_influence = report.taken_out;
  const ThermalSensorProperties properties = ToProto(found);
  if (report.curve.IsKnown())
    *sensor.mutable_radiometric_correction() = properties.radiometric_correction();
  record.set_views(static_cast<int>(report.rows.size()));
  if (!report.influence) return;
  // Also if there is none.
  sensor.clear_scene_influence();
  if (properties.has_scene_influence())
    *sensor.mutable_scene_influence() = properties.scene_influence();
  if (!report.influence->IsKnown()) return;
  record.set_parameters("near_fraction near_sigma_px total_fraction");
  for (const double value : report.influence->covariance.reshaped()) record.add_covariance(value);
}

void SetFindings(const RadiometricArguments& arguments, const RadiometricFindings& found,
                 RigCalibration& rig) {
  ThermalSensorProperties& sensor = *rig.mutable_thermal_sensor();
  if (found.drift && found.drift->IsKnown()) {
    HousingDriftProperties& drift = *sensor.mutable_housing_drift();
    drift.set_error_per_kelvin(found.drift->drift.error_per_kelvin);
    drift.set_sigma(found.drift->drift.sigma);
  }
  // The record tells of the black bodies, if there ever were any.
  if (!found.readings && rig.has_radiometric_calibration()) return;
  CalibrationRecord& record = *rig.mutable_radiometric_calibration();
  record.Clear();
  record.set_date(Today());
  record.set_method(fmt::format("{}, calibrate radiometric", SoftwareName()));
  record.set_target(found.readings ? fmt::format("black bodies {}", arguments.table)
                                   : fmt::format("warm-up {}", arguments.warm_up));
  if (rig.has_thermal_serial()) record.set_serial(rig.thermal_serial());
  if (found.readings) SetReadings(*found.readings, record, sensor);
}

Status CheckArguments(const RadiometricArguments& arguments) {
  const RadiometricConditions& conditions = arguments.conditions;
  if (arguments.table.empty() && arguments.warm_up.empty()) {
    return InvalidArgument(
        "nothing to calibrate by: name a table of black bodies, or a recording of a camera that "
        "warms up, --warm-up");
  }
  if (!(conditions.emissivity > 0.0 && conditions.emissivity <= 1.0)) {
    return InvalidArgument(
        fmt::format("--emissivity must be above 0 and at most 1, got {}", conditions.emissivity));
  }
  if (!(conditions.reflected_celsius >= -100.0 && conditions.reflected_celsius <= 1000.0)) {
    return InvalidArgument(
        fmt::format("--reflected must be -100 to 1000 °C, got {}", conditions.reflected_celsius));
  }
  if (!(conditions.emissivity_sigma >= 0.0 && conditions.emissivity_sigma <= 0.5)) {
    return InvalidArgument(
        fmt::format("--emissivity-sigma must be 0 to 0.5, got {}", conditions.emissivity_sigma));
  }
  if (!(conditions.reflected_sigma_k >= 0.0 && conditions.reflected_sigma_k <= 50.0)) {
    return InvalidArgument(
        fmt::format("--reflected-sigma must be 0 to 50 K, got {}", conditions.reflected_sigma_k));
  }
  if (!(conditions.common_sigma_k >= 0.0 && conditions.common_sigma_k <= 50.0)) {
    return InvalidArgument(
        fmt::format("--calibrator-sigma must be 0 to 50 K, got {}", conditions.common_sigma_k));
  }
  return OkStatus();
}

/// Writes the calibration, if that was asked for.
Status WriteFindings(const RadiometricArguments& arguments, const RadiometricFindings& found,
                     const std::optional<Rig>& rig) {
  const bool has_readings =
      found.readings && (found.readings->curve.IsKnown() || found.readings->influence);
  if (!has_readings && !(found.drift && found.drift->IsKnown())) {
    fmt::print("nothing to write{}\n",
               arguments.output.empty() ? "" : fmt::format(", {} is not made", arguments.output));
    return OkStatus();
  }
  if (arguments.output.empty() && !arguments.apply) {
    fmt::print("nothing is written: --apply changes the file of --rig, --output writes another\n");
    return OkStatus();
  }
  if (!rig) {
    return FailedPrecondition(
        "none of the images is a recording with a calibration: name the one to change, --rig");
  }
  return WriteCalibratedRig({arguments.rig, arguments.apply ? arguments.rig : arguments.output},
                            *rig,
                            [&](RigCalibration& file) { SetFindings(arguments, found, file); });
}

/// Finds what was asked for. `rig` as for CalibrateReadings.
Result<RadiometricFindings> Find(const RadiometricArguments& arguments, std::optional<Rig>& rig) {
  ProgressBar bar("calibrating", 0, "");
  const bool has_both = !arguments.warm_up.empty() && !arguments.table.empty();
  const double first_part = has_both ? 0.5 : 0.0;
  RadiometricFindings found;
  if (!arguments.warm_up.empty()) {
    auto drift = FindHousingDrift(arguments.warm_up, rig, [&](double fraction) {
      bar.Update(has_both ? first_part * fraction : fraction);
    });
    if (!drift) return Err(drift.error());
    found.drift = *drift;
    // Readings before black bodies drift, too.
    if (rig && drift->IsKnown()) rig->thermal_sensor.housing_drift = drift->drift;
  }
  if (!arguments.table.empty()) {
    auto readings = CalibrateReadings(
        arguments.table, arguments.conditions, rig,
        [&](double fraction) { bar.Update(first_part + (1.0 - first_part) * fraction); });
    if (!readings) return Err(readings.error());
    found.readings = std::move(*readings);
  }
  bar.Finish();
  return found;
}

int RunRadiometric(const RadiometricArguments& arguments) {
  if (Status status = CheckArguments(arguments); !status.ok()) return Fail(status);
  std::optional<Rig> rig;
  if (!arguments.rig.empty()) {
    Result<Rig> loaded = LoadRigCalibration(arguments.rig);
    if (!loaded) return Fail(loaded.error());
    rig = std::move(*loaded);
  }
  const Result<RadiometricFindings> found = Find(arguments, rig);
  if (!found) return Fail(found.error());
  std::string text;
  if (found->readings) text += ReportText(arguments.conditions, *found->readings);
  if (found->drift) text += DriftText(*found->drift);
  fmt::print("{}", text);
  if (!arguments.html.empty()) {
    if (Status status = WriteFile(arguments.html, RadiometricHtml(*found, text)); !status.ok())
      return Fail(status);
    fmt::print("{}: written\n", arguments.html);
  }
  if (!arguments.json.empty()) {
    if (Status status = WriteFile(arguments.json, JsonText(ReportJson(*found))); !status.ok())
      return Fail(status);
    fmt::print("{}: written\n", arguments.json);
  }
  const Status status = WriteFindings(arguments, *found, rig);
  return status.ok() ? 0 : Fail(status);
}

}  // namespace

void AddCalibrateRadiometricCommand(CLI::App& calibrate, CommandBody& body) {
  CLI::App* command = calibrate.add_subcommand(
      "radiometric", "By what the thermal camera's readings are wrong, before black bodies");
  auto arguments = std::make_shared<RadiometricArguments>();
  command->add_option("table", arguments->table, "Table of black bodies and what they read (.csv)");
  command->add_option("--warm-up", arguments->warm_up,
                      "Recording of a camera that rests while it warms up (.mcap)");
  CLI::Option* rig_option =
      command->add_option("--rig", arguments->rig,
                          "Calibration to change; without, that of the table's first recording");
  CLI::Option* apply_option =
      command->add_flag("--apply", arguments->apply, "Change the file of --rig")->needs(rig_option);
  command->add_option("-o,--output", arguments->output, "Write the calibration here instead")
      ->excludes(apply_option);
  command->add_option("--json", arguments->json, "Write all values (.json)");
  command->add_option("--html", arguments->html, "Write the report with plots (.html)");
  command
      ->add_option("--emissivity", arguments->conditions.emissivity,
                   "Of the black body, in the camera's band")
      ->capture_default_str();
  command
      ->add_option("--reflected", arguments->conditions.reflected_celsius,
                   "Temperature of what the black body reflects, °C")
      ->capture_default_str();
  command
      ->add_option("--emissivity-sigma", arguments->conditions.emissivity_sigma,
                   "Standard uncertainty of the emissivity")
      ->capture_default_str();
  command
      ->add_option("--reflected-sigma", arguments->conditions.reflected_sigma_k,
                   "Standard uncertainty of the reflected temperature, K")
      ->capture_default_str();
  command
      ->add_option("--calibrator-sigma", arguments->conditions.common_sigma_k,
                   "Standard uncertainty that all temperatures of the black body have together, by "
                   "its certificate, K")
      ->capture_default_str();
  command->footer(kRadiometricFooter);
  command->callback(
      [arguments, &body] { body = [arguments] { return RunRadiometric(*arguments); }; });
}

}  // namespace isotherm
