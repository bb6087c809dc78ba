#include "ground/radiometric_calibration/radiometric_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/dataset/text_lines.h"
#include "common/radiometry/radiometry.h"
#include "ground/radiometric_calibration/mean_image.h"
#include "ground/thermal/scene_influence_corrector.h"

namespace isotherm {
namespace {

constexpr double kReading = 0.7;  // Of the progress.
/// A camera that is right within its data sheet is far nearer; beyond, a row names other images.
constexpr double kMaxWrong_k = 50.0;
/// All are kept while the influence is looked for.
constexpr std::size_t kMaxImages = 100;
/// A part of an emissivity, for a derivative.
constexpr double kStep = 1e-3;

/// Views of the rows that have images, in their order.
struct Images {
  std::vector<ApertureView> views;
  std::vector<std::size_t> rows;  ///< By view.
};

Status CheckSize(const Image<float>& image, const std::optional<Rig>& rig) {
  if (!rig || !rig->thermal ||
      (rig->thermal->width == image.width() && rig->thermal->height == image.height()))
    return OkStatus();
  return FailedPrecondition(fmt::format(
      "has images of {} x {} pixels, the calibration's thermal camera {} x {}: save them as the "
      "camera gives them, or name its own calibration, --rig",
      image.width(), image.height(), rig->thermal->width, rig->thermal->height));
}

Result<Images> ReadImages(const std::function<void(double)>& progress, std::optional<Rig>& rig,
                          RadiometricReport& report) {
  Images images;
  const auto count = static_cast<double>(report.rows.size());
  // Rows of one set point show the black body at one temperature.
  std::vector<double> settings;
  for (std::size_t i = 0; i < report.rows.size(); ++i) {
    RowReport& row = report.rows[i];
    if (row.row.reading_celsius) continue;
    const auto fail = [&](const Status& status) {
      return Err(status.WithContext(row.row.images.string()));
    };
    Result<MeanImage> mean = ReadMeanImage(row.row.images, rig, [&](double fraction) {
      progress((static_cast<double>(i) + fraction) / count);
    });
    if (!mean) return Err(mean.error());
    Result<ApertureImage> image = FindAperture(std::move(mean->celsius), row.row.body_celsius);
    if (!image) return fail(image.error());
    row.frames = mean->frames;
    row.hole_radius_px = image->fills_image() ? 0.0 : image->hole_radius_px;
    row.measured_celsius = MeanOf(image->body, image->celsius);
    if (!images.views.empty() &&
        (image->celsius.width() != images.views.front().image.celsius.width() ||
         image->celsius.height() != images.views.front().image.celsius.height())) {
      return fail(FailedPrecondition("has images of another size than those of the rows before"));
    }
    if (Status status = CheckSize(image->celsius, rig); !status.ok()) return fail(status);
    if (images.views.size() == kMaxImages) {
      return fail(FailedPrecondition(
          fmt::format("more than {} rows with images: take several tables", kMaxImages)));
    }
    const auto known = std::ranges::find(settings, row.row.body_celsius);
    const auto setting = static_cast<int>(known - settings.begin());
    if (known == settings.end()) settings.push_back(row.row.body_celsius);
    images.views.push_back({std::move(*image), setting});
    images.rows.push_back(i);
  }
  return images;
}

/// Finds out what is taken out of the images.
void FindInfluence(const std::optional<Rig>& rig, const Images& images, RadiometricReport& report) {
  if (rig) report.taken_out = rig->thermal_sensor.scene_influence;
  const bool has_holes = std::ranges::any_of(
      images.views, [](const ApertureView& view) { return !view.image.fills_image(); });
  if (!has_holes) return;
  const Result<InfluenceReport> found = FitInfluence(images.views);
  if (!found) {
    report.why_no_influence = found.error().message();
    return;
  }
  report.influence = *found;
  if (found->IsKnown()) {
    report.taken_out = found->influence;
    return;
  }
  report.why_no_influence =
      fmt::format("holes that were left out read {:.2f} K apart as measured and {:.2f} K corrected",
                  found->apart_before_k, found->apart_after_k);
  // A camera that has none must not be corrected as if it had.
  const double apart_k = ApartWithout(report.taken_out, images.views);
  if (report.taken_out.Total() == 0.0 || apart_k < found->apart_before_k) return;
  report.taken_out = {};
  report.why_no_influence +=
      fmt::format("; with that of the calibration {:.2f} K: it has to go", apart_k);
}

void TakeInfluenceOut(const Images& images, RadiometricReport& report) {
  for (std::size_t i = 0; i < images.views.size(); ++i) {
    const ApertureImage& image = images.views[i].image;
    Image<float> celsius = image.celsius;
    if (report.taken_out.Total() > 0.0)
      SceneInfluenceCorrector(report.taken_out, celsius.width(), celsius.height()).Correct(celsius);
    report.rows[images.rows[i]].own_celsius = MeanOf(image.body, celsius);
  }
}

Status CheckRow(const RowReport& row) {
  const double wrong_k = row.apparent_celsius - row.own_celsius;
  if (std::abs(wrong_k) <= kMaxWrong_k) return OkStatus();
  return FailedPrecondition(fmt::format(
      "the camera should read {:.1f} °C and reads {:.1f} °C: is the row right, and does it look at "
      "the black body?",
      row.apparent_celsius, row.own_celsius));
}

/// Sets what a right camera reads of a row's black body, and how uncertain that is for all rows
/// together (GUM 5.1.2, by differences).
Status SetApparent(const BandRadiance& band, const RadiometricConditions& conditions,
                   RowReport& row) {
  const auto apparent = [&](double emissivity, double reflected_celsius) {
    return ApparentCelsius(band, row.row.body_celsius, emissivity, reflected_celsius);
  };
  const double emissivity = conditions.emissivity, reflected = conditions.reflected_celsius;
  row.apparent_celsius = apparent(emissivity, reflected);
  const double slope = (row.apparent_celsius - apparent((1.0 - kStep) * emissivity, reflected)) /
                       (kStep * emissivity);
  const double reflection_k =
      apparent(emissivity, reflected + conditions.reflected_sigma_k) - row.apparent_celsius;
  row.common_sigma_k =
      std::hypot(conditions.common_sigma_k, conditions.emissivity_sigma * slope, reflection_k);
  if (std::isnan(row.common_sigma_k))
    return FailedPrecondition("with this emissivity and reflected temperature it cannot be");
  return OkStatus();
}

/// One for each temperature of the black body, however often it was looked at: what is wrong with
/// the black body then is wrong with all of them.
std::vector<SetPoint> SetPointsOf(const std::vector<RowReport>& rows) {
  struct Sum {
    double apparent = 0.0, reading = 0.0, variance = 0.0, common = 0.0;
    int rows = 0;
  };
  std::map<double, Sum> by_temperature;
  for (const RowReport& row : rows) {
    Sum& sum = by_temperature[row.row.body_celsius];
    const double sigma_k = row.row.sigma_k.value_or(0.0);
    sum.apparent += row.apparent_celsius;
    sum.reading += row.own_celsius;
    sum.variance += sigma_k * sigma_k;
    sum.common += row.common_sigma_k;
    ++sum.rows;
  }
  std::vector<SetPoint> points;
  for (const auto& [temperature, sum] : by_temperature) {
    points.push_back({sum.apparent / sum.rows, sum.reading / sum.rows,
                      std::sqrt(sum.variance / sum.rows), sum.common / sum.rows});
  }
  return points;
}

}  // namespace

bool RadiometricReport::IsRightAsItIs() const {
  const RadiometricCorrection& table = curve.correction;
  for (std::size_t i = 0; i < table.readings_celsius.size(); ++i)
    if (std::abs(table.corrections_k[i]) > 2.0F * table.sigmas_k[i]) return false;
  return true;
}

Result<RadiometricReport> CalibrateReadings(const std::filesystem::path& table,
                                            const RadiometricConditions& conditions,
                                            std::optional<Rig>& rig,
                                            const std::function<void(double)>& progress) {
  const Result<std::string> text = ReadTextFile(table);
  if (!text) return Err(text.error());
  auto rows = ParseSetPoints(*text, table.string(), table.parent_path());
  if (!rows) return Err(rows.error());
  RadiometricReport report;
  const BandRadiance band;
  for (SetPointRow& row : *rows) {
    const double reading = row.reading_celsius.value_or(0.0);
    report.rows.push_back(
        {.row = std::move(row), .measured_celsius = reading, .own_celsius = reading});
    RowReport& added = report.rows.back();
    if (Status status = SetApparent(band, conditions, added); !status.ok())
      return Err(status.WithContext(fmt::format("{}:{}", table.string(), added.row.line)));
  }
  const Result<Images> images =
      ReadImages([&](double fraction) { progress(kReading * fraction); }, rig, report);
  if (!images) return Err(images.error());
  FindInfluence(rig, *images, report);
  TakeInfluenceOut(*images, report);
  for (const RowReport& row : report.rows) {
    if (Status status = CheckRow(row); !status.ok())
      return Err(status.WithContext(fmt::format("{}:{}", table.string(), row.row.line)));
  }
  const std::vector<SetPoint> points = SetPointsOf(report.rows);
  report.temperatures = static_cast<int>(points.size());
  Result<CurveReport> curve = FitCurve(points);
  if (!curve) return Err(curve.error().WithContext(table.string()));
  report.curve = std::move(*curve);
  for (RowReport& row : report.rows) {
    row.left_k =
        row.apparent_celsius - row.own_celsius - report.curve.correction.At(row.own_celsius);
  }
  progress(1.0);
  return report;
}

}  // namespace isotherm
