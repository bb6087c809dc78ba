#include "ground/measuring/surface_sum.h"

#include <cmath>

#include "common/frame/radiometric_scale.h"
#include "ground/measuring/voxel_record.h"
#include "ground/thermal/measurement_quality.h"

namespace isotherm {

double RadiatedHeat_w_m2(double surface_celsius, const ObjectParameterValues& values) {
  const double surface_k = surface_celsius + kCelsiusZero_k;
  const double around_k = values.reflected_celsius + kCelsiusZero_k;
  return values.emissivity * kStefanBoltzmann *
         (std::pow(surface_k, 4.0) - std::pow(around_k, 4.0));
}

double ConvectedHeat_w_m2(double surface_celsius, const ObjectParameterValues& values) {
  return values.film_coefficient_w_m2k * (surface_celsius - values.air_celsius);
}

void SurfaceSum::Moments::Add(double celsius, double sigma_k, const Eigen::Vector3f& point,
                              double new_weight) {
  if (weight == 0.0) origin = celsius;
  const double off = celsius - origin;
  weight += new_weight;
  sum += new_weight * off;
  squares += new_weight * off * off;
  if (!std::isnan(sigma_k)) {
    sigma_weight += new_weight;
    sigma_squares += new_weight * sigma_k * sigma_k;
  }
  if (!hottest || celsius > hottest->celsius) hottest = {celsius, point};
  if (!coldest || celsius < coldest->celsius) coldest = {celsius, point};
}

std::optional<measuring::Statistics> SurfaceSum::Moments::Describe() const {
  if (!(weight > 0.0)) return std::nullopt;
  measuring::Statistics statistics;
  const double mean = sum / weight;
  statistics.set_min_celsius(coldest->celsius);
  statistics.set_max_celsius(hottest->celsius);
  statistics.set_mean_celsius(origin + mean);
  statistics.set_deviation_k(std::sqrt(std::max(0.0, squares / weight - mean * mean)));
  if (sigma_weight > 0.0) statistics.set_sigma_k(std::sqrt(sigma_squares / sigma_weight));
  *statistics.mutable_hottest() = ToMessage(hottest->point);
  *statistics.mutable_coldest() = ToMessage(coldest->point);
  return statistics;
}

void SurfaceSum::Add(const CloudPoint& point, double weight) {
  if (!(weight > 0.0)) return;
  total_ += weight;
  const bool was_tried = point.distance_class != kNeverMeasured;
  const MeasurementQuality quality =
      was_tried ? QualityOf(point.distance_class, point.angle_class, point.motion_class)
                : MeasurementQuality::kNever;
  by_quality_[static_cast<std::size_t>(quality)] += weight;
  if (std::isnan(point.celsius)) return;
  apparent_.Add(point.celsius, point.sigma_k, point.position_m, weight);
  const double object = interpretation_.ObjectCelsius(0, point.celsius, point.measured_angle_deg);
  if (std::isnan(object)) return;
  const double sigma =
      interpretation_.ObjectSigma(0, point.celsius, point.sigma_k, point.measured_angle_deg);
  object_.Add(object, sigma, point.position_m, weight);
  radiation_w_ += weight * RadiatedHeat_w_m2(object, values_);
  convection_w_ += weight * ConvectedHeat_w_m2(object, values_);
}

measuring::Fractions SurfaceSum::quality() const {
  measuring::Fractions fractions;
  if (!(total_ > 0.0)) return fractions;
  fractions.set_good(by_quality_[0] / total_);
  fractions.set_acceptable(by_quality_[1] / total_);
  fractions.set_bad(by_quality_[2] / total_);
  fractions.set_never(by_quality_[3] / total_);
  return fractions;
}

measuring::HeatFlow SurfaceSum::heat_flow() const {
  measuring::HeatFlow flow;
  flow.set_radiation_w(radiation_w_);
  flow.set_convection_w(convection_w_);
  flow.set_total_w(radiation_w_ + convection_w_);
  flow.set_measured_m2(object_.weight);
  if (object_.weight > 0.0)
    flow.set_extrapolated_w((radiation_w_ + convection_w_) * total_ / object_.weight);
  flow.set_film_coefficient_w_m2k(values_.film_coefficient_w_m2k);
  flow.set_air_celsius(values_.air_celsius);
  flow.set_reflected_celsius(values_.reflected_celsius);
  flow.set_emissivity(values_.emissivity);
  return flow;
}

}  // namespace isotherm
