#include "common/doubts/doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/quantile.h"
#include "common/frame/frame.h"

namespace isotherm {
namespace {

// These limits lie far outside of what such cameras and rigs do, so that a value beyond one is a
// wrong unit or a wrong column rather than an unusual scan. Wider: mistakes by a factor of ten
// pass; narrower: somebody's odd rig is doubted, which costs a sentence and nothing else.
// doubts_test has both sides of each.
constexpr double kMaxCameraDistance_m = 1.0;
constexpr double kMaxDelay_s = 1.0;
// Coarser than a decimetre per unit is metres written as whole numbers.
constexpr double kMinDepthScale = 10.0;
// Depth and thermal cameras deliver between a few frames a second and 200.
constexpr double kMinRate_hz = 1.0;
constexpr double kMaxRate_hz = 1000.0;
/// The slowest that may be meant: a time lapse.
constexpr double kMaxPeriod_s = 600.0;
/// Streams of one scan begin and end together, within seconds. Two clocks put them hours apart.
constexpr double kMinOverlap = 0.5;
// Medians of whole images: structured light and time of flight measure neither nearer nor farther.
constexpr double kMinDepth_m = 0.2, kMaxDepth_m = 20.0;
// Means of whole images, from a cold store to the inside of a furnace.
constexpr double kMinMean_celsius = -40.0, kMaxMean_celsius = 1500.0;
// Something in the image may be too hot for the scale; all of it only if the scale is wrong.
constexpr double kMaxSaturated = 0.99;
/// A reading of numbers in another unit must lie in here to be named as the cause.
constexpr double kLikelyMin_celsius = -20.0, kLikelyMax_celsius = 500.0;
constexpr double kLikelyMin_m = 0.3, kLikelyMax_m = 5.0;

struct Unit {
  const char* name;
  double per_si;
};

/// The unit in which the period would be that of a camera of a few hertz to a few hundred.
const Unit* LikelyUnit(double period_s) {
  static constexpr std::array<Unit, 3> kUnits = {
      {{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}}};
  const auto unit = std::ranges::find_if(kUnits, [period_s](const Unit& candidate) {
    const double rate_hz = candidate.per_si / period_s;
    return rate_hz >= 2.0 && rate_hz <= 200.0;
  });
  return unit == kUnits.end() ? nullptr : &*unit;
}

/// "stamps are seconds; these look like ..."; a general question where no unit fits.
std::string CauseOfPeriod(double period_s) {
  const Unit* unit = LikelyUnit(period_s);
  if (unit == nullptr) return "stamps are seconds: are these in another unit?";
  return fmt::format("stamps are seconds; these look like {} ({:.1f} Hz): divide them by {:.0f}",
                     unit->name, unit->per_si / period_s, unit->per_si);
}

void CheckRate(std::string_view name, const StreamTimes& times, Doubts& doubts) {
  if (times.period_s <= 0.0) {
    if (times.frames > 2)
      doubts.push_back(fmt::format("{}: most frames have the time stamp of another one", name));
    return;
  }
  const double rate_hz = 1.0 / times.period_s;
  // An image every few seconds may be meant so.
  if (rate_hz < kMinRate_hz &&
      (LikelyUnit(times.period_s) != nullptr || times.period_s > kMaxPeriod_s)) {
    doubts.push_back(fmt::format("{}: one frame every {:.6g} s, {:.6g} s in all: {}", name,
                                 times.period_s, ToSeconds(times.last - times.first),
                                 CauseOfPeriod(times.period_s)));
  } else if (rate_hz > kMaxRate_hz) {
    doubts.push_back(fmt::format(
        "{}: {:.0f} frames a second, which no camera of this kind has: stamps are seconds, are "
        "these in a larger unit?",
        name, rate_hz));
  }
}

void CheckOverlap(const StreamTimes& depth, const StreamTimes& thermal, Doubts& doubts) {
  if (depth.frames < 2 || thermal.frames < 2) return;
  const double common_s =
      ToSeconds(std::min(depth.last, thermal.last) - std::max(depth.first, thermal.first));
  const double shorter_s =
      std::min(ToSeconds(depth.last - depth.first), ToSeconds(thermal.last - thermal.first));
  // Stamps of the first and the last frame are each off by up to a period of the slower stream.
  const double uncertainty_s = 2.0 * std::max(depth.period_s, thermal.period_s);
  if (common_s >= kMinOverlap * shorter_s - uncertainty_s) return;
  doubts.push_back(fmt::format(
      "thermal frames begin {:+.3f} s after the depth frames, and the two overlap for {:.3f} s "
      "only: they seem to be stamped by two clocks; give both streams stamps of one clock, or the "
      "difference as thermal_delay_s of the calibration",
      ToSeconds(thermal.first - depth.first), std::max(0.0, common_s)));
}

double ToCelsius(double kelvin) { return kelvin - kCelsiusZero_k; }

bool IsLikely(double celsius) {
  return celsius >= kLikelyMin_celsius && celsius <= kLikelyMax_celsius;
}

/// Returns what pixels with this mean would be in the units that are confused with each other.
std::string CauseOfMean(double mean) {
  std::string readings;
  const auto add = [&readings](const char* unit, double celsius) {
    if (!IsLikely(celsius)) return;
    readings +=
        fmt::format("{}as {} they would be {:.1f} °C", readings.empty() ? "" : ", ", unit, celsius);
  };
  add("centi-kelvin (thermal_scale: 0.01)", kCentikelvin.Celsius(mean));
  add("centi-degrees Celsius", mean / 100.0);
  add("deci-kelvin", ToCelsius(mean / 10.0));
  add("kelvin / 64", ToCelsius(mean / 64.0));
  return readings.empty() ? "are they raw counts?" : readings + ", or they may be raw counts";
}

}  // namespace

Doubts DoubtsAbout(const Rig& rig) {
  Doubts doubts;
  if (rig.T_thermal_depth) {
    const double distance_m = rig.T_thermal_depth->translation().norm();
    if (distance_m > kMaxCameraDistance_m) {
      const bool are_millimetres = distance_m / 1e3 <= kMaxCameraDistance_m;
      doubts.push_back(fmt::format(
          "T_thermal_depth puts the cameras {:.4g} m apart: tx ty tz are metres{}", distance_m,
          are_millimetres ? fmt::format("; as millimetres they would be {:.4g} m: divide them by "
                                        "1000",
                                        distance_m / 1e3)
                          : ""));
    }
  }
  if (std::abs(rig.thermal_delay_s) > kMaxDelay_s) {
    doubts.push_back(
        fmt::format("thermal_delay_s is {:.6g} s: cameras are late by milliseconds; is it in "
                    "milliseconds, or are the streams stamped by two clocks?",
                    rig.thermal_delay_s));
  }
  if (rig.depth && rig.depth_scale < kMinDepthScale) {
    doubts.push_back(fmt::format(
        "depth_scale is {:.6g} units per metre: images of whole metres show no surface; "
        "millimetres are depth_scale: 1000",
        rig.depth_scale));
  }
  return doubts;
}

StreamTimes MeasureTimes(std::vector<CaptureTime>& times) {
  StreamTimes result;
  result.frames = times.size();
  if (times.empty()) return result;
  std::sort(times.begin(), times.end());
  result.first = times.front();
  result.last = times.back();
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < times.size(); ++i)
    periods_s.push_back(ToSeconds(times[i] - times[i - 1]));
  if (!periods_s.empty()) result.period_s = TakeMedian(periods_s);
  return result;
}

Doubts DoubtsAboutTimes(const StreamTimes& depth, const StreamTimes& thermal) {
  Doubts doubts;
  CheckRate("depth", depth, doubts);
  CheckRate("thermal", thermal, doubts);
  // Where stamps are in a wrong unit, the overlap says nothing.
  if (doubts.empty()) CheckOverlap(depth, thermal, doubts);
  return doubts;
}

Doubts DoubtsAboutDepths(double median_raw, double depth_scale) {
  if (!(depth_scale > 0.0)) return {};
  const double median_m = median_raw / depth_scale;
  if (median_raw > 0.0 && median_m >= kMinDepth_m && median_m <= kMaxDepth_m) return {};
  if (median_raw <= 0.0) {
    return {
        "no depth pixel that was looked at has a value: is the camera covered, or does something "
        "else than 16-bit depth stand in the images?"};
  }
  std::string text = fmt::format(
      "the depth images say {:.4g} m (median) with depth_scale {:.6g}, which such cameras do not "
      "measure",
      median_m, depth_scale);
  for (const double scale : {1000.0, 5000.0, 10000.0, 100.0}) {
    const double other_m = median_raw / scale;
    if (other_m < kLikelyMin_m || other_m > kLikelyMax_m) continue;
    text += fmt::format(": depth_scale {:.0f} would make it {:.3g} m", scale, other_m);
    break;
  }
  return {text + "; correct depth_scale in the calibration (raw units per metre)"};
}

Doubts DoubtsAboutTemperatures(const ThermalPixels& pixels) {
  if (pixels.none_ratio >= 1.0)
    return {
        "no thermal pixel that was looked at has a value (all are 0): temperatures are expected, "
        "centi-kelvin unless thermal_scale in the calibration says otherwise"};
  if (pixels.saturated_ratio >= kMaxSaturated) {
    return {
        fmt::format("nearly all thermal pixels have the largest value there is (65535, {:.0f} °C): "
                    "the images must be of what is colder than that, or their scale a coarser one "
                    "(thermal_scale in the calibration: 0.03 reaches to 1692 °C)",
                    pixels.scale.max_celsius())};
  }
  const double celsius = pixels.scale.Celsius(pixels.mean_raw);
  if (celsius >= kMinMean_celsius && celsius <= kMaxMean_celsius) return {};
  return {
      fmt::format("the mean of the thermal images is {:.1f} °C with thermal_scale {:g} and "
                  "thermal_offset {:g} (default: centi-kelvin, kelvin x 100); {}: convert them, or "
                  "correct the calibration",
                  celsius, pixels.scale.kelvin_per_count, pixels.scale.offset_kelvin,
                  CauseOfMean(pixels.mean_raw))};
}

}  // namespace isotherm
