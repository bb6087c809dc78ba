#pragma once

#include <Eigen/Core>
#include <optional>

#include "ground/interpretation/interpretation.h"
#include "ground/measuring/measuring.pb.h"
#include "ground/measuring/object_temperatures.h"
#include "ground/mesh/surface.h"

namespace isotherm {

/// Stefan-Boltzmann constant, W/(m2 K4) (CODATA 2018, exact since 2019).
inline constexpr double kStefanBoltzmann = 5.670374419e-8;

/// Heat that one square metre at `surface_celsius` gives off, W: radiation of a grey body into
/// surroundings of one temperature, and what the air takes (docs/measuring.md).
double RadiatedHeat_w_m2(double surface_celsius, const ObjectParameterValues& values);
double ConvectedHeat_w_m2(double surface_celsius, const ObjectParameterValues& values);

/// Sums temperatures up over pieces of surface, or over samples of equal weight. Thread-compatible.
class SurfaceSum {
 public:
  SurfaceSum(const Interpretation& interpretation, const ObjectParameterValues& values)
      : interpretation_(interpretation), values_(values) {}

  /// A piece of surface that is as `point` says; `weight` in square metres.
  void Add(const CloudPoint& point, double weight);

  double total() const { return total_; }
  measuring::Fractions quality() const;
  /// nullopt if nothing is measured.
  std::optional<measuring::Statistics> object() const { return object_.Describe(); }
  std::optional<measuring::Statistics> apparent() const { return apparent_.Describe(); }
  /// The weights are areas.
  measuring::HeatFlow heat_flow() const;

 private:
  struct Extreme {
    double celsius = 0.0;
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
  };
  /// One kind of temperature.
  struct Moments {
    double weight = 0.0, sum = 0.0, squares = 0.0;  ///< Over differences to `origin`.
    double origin = 0.0;                            ///< The first temperature.
    double sigma_weight = 0.0, sigma_squares = 0.0;
    std::optional<Extreme> hottest, coldest;

    void Add(double celsius, double sigma_k, const Eigen::Vector3f& point, double weight);
    std::optional<measuring::Statistics> Describe() const;
  };

  const Interpretation& interpretation_;
  const ObjectParameterValues values_;
  double total_ = 0.0;
  double by_quality_[4] = {};
  Moments object_, apparent_;
  double radiation_w_ = 0.0, convection_w_ = 0.0;
};

}  // namespace isotherm
