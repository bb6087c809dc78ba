#include "ground/service/conclusion.h"

#include <fmt/format.h>

namespace isotherm {
namespace {

std::string BehindText(const BehindCounts& behind, const std::filesystem::path& recording) {
  if (behind.thermal_frames == 0) return {};
  return fmt::format(
      "behind   {} thermal frames were left out to keep up: isotherm reconstruct {} -o FOLDER "
      "uses them\n",
      behind.thermal_frames, recording.empty() ? "RECORDING" : recording.string());
}

}  // namespace

std::string ConclusionText(const BehindCounts& behind, const SurfaceAreas& areas,
                           double done_fraction, const std::filesystem::path& recording) {
  const std::string text = BehindText(behind, recording);
  if (!(areas.total_m2() > 0.0)) return text;
  const auto percent = [&](double area_m2) { return 100.0 * area_m2 / areas.total_m2(); };
  const std::string measured = fmt::format("next     measured well: {:.0f} % of {:.2f} m2",
                                           percent(areas.good_m2), areas.total_m2());
  if (areas.good_m2 >= done_fraction * areas.total_m2())
    return text + measured + ", as was asked for: the scan is done\n";
  return text + measured +
         fmt::format(
             ", {:.0f} % are asked for: go on with the {:.0f} % that were never measured and the "
             "{:.0f} % from a bad distance or angle\n",
             100.0 * done_fraction, percent(areas.never_m2), percent(areas.bad_m2));
}

}  // namespace isotherm
