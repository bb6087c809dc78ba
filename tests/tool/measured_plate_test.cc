// Measures a plate of known size and temperature through the whole chain: simulated cameras,
// reconstruction, `isotherm measure`.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "tests/support/tool.h"

namespace isotherm::testing {
namespace {

// The target of the simulated calibrator: a disc that looks towards the operator.
constexpr double kCentreX_m = 0.49, kCentreY_m = 0.565, kFrontZ_m = 0.514;
constexpr double kHot_celsius = 100.0, kSurround_celsius = 23.0, kEmissivity = 0.95;
constexpr double kFilm_w_m2k = 10.0;

// A regular polygon on the target, well within its rim.
constexpr int kCorners = 24;
constexpr double kRadius_m = 0.055;

nlohmann::json Vector(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }

std::string ShapeFile() {
  nlohmann::json area{{"id", "plate"},
                      {"name", "plate"},
                      {"kind", "AREA"},
                      {"parameters",
                       {{"emissivity", kEmissivity},
                        {"reflected_celsius", kSurround_celsius},
                        {"air_celsius", kSurround_celsius},
                        {"film_coefficient_w_m2k", kFilm_w_m2k}}}};
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    area["anchors"].push_back({{"origin", Vector(kCentreX_m + kRadius_m * std::cos(angle),
                                                 kCentreY_m + kRadius_m * std::sin(angle), 0.3)},
                               {"direction", Vector(0, 0, 1)}});
  }
  return nlohmann::json{{"shapes", {area}}}.dump();
}

/// Kelvin.
double Fourth(double celsius) { return std::pow(celsius + 273.15, 4); }

TEST_F(ToolRun, AreaAndHeatFlowOfAPlateAreThoseOfTheClosedForm) {
  RunWell("simulate --scene calibrator --duration 8 -o scan.mcap --set scene.hot_celsius=" +
          std::to_string(kHot_celsius));
  RunWell("reconstruct scan.mcap --initial-pose-from scan.mcap -o out");
  Write("shapes.json", ShapeFile());
  RunWell("measure out --shapes shapes.json --json values.json");
  const auto values = nlohmann::json::parse(ReadAll(folder_ / "values.json"));
  const nlohmann::json& plate = values.at("measured").at(0);

  const double area_m2 =
      0.5 * kCorners * kRadius_m * kRadius_m * std::sin(2.0 * std::numbers::pi / kCorners);
  EXPECT_NEAR(plate.at("area_m2").get<double>() / area_m2, 1.0, 0.02);
  EXPECT_GT(plate.at("heat_flow").at("measured_m2").get<double>(), 0.98 * area_m2);
  EXPECT_NEAR(plate.at("object").at("mean_celsius").get<double>(), kHot_celsius, 0.5);
  constexpr double kStefanBoltzmann = 5.670374419e-8;
  const double radiation_w =
      area_m2 * kEmissivity * kStefanBoltzmann * (Fourth(kHot_celsius) - Fourth(kSurround_celsius));
  const double convection_w = area_m2 * kFilm_w_m2k * (kHot_celsius - kSurround_celsius);
  const nlohmann::json& heat = plate.at("heat_flow");
  EXPECT_NEAR(heat.at("radiation_w").get<double>() / radiation_w, 1.0, 0.02);
  EXPECT_NEAR(heat.at("convection_w").get<double>() / convection_w, 1.0, 0.02);
  EXPECT_NEAR(heat.at("total_w").get<double>() / (radiation_w + convection_w), 1.0, 0.02);
  std::cout << "plate: area " << 1e4 * plate.at("area_m2").get<double>() << " cm2 of "
            << 1e4 * area_m2 << ", heat flow " << heat.at("total_w").get<double>() << " W of "
            << radiation_w + convection_w << ", mean "
            << plate.at("object").at("mean_celsius").get<double>() << " °C\n";
}

}  // namespace
}  // namespace isotherm::testing
