#include <fmt/format.h>

#include <cmath>

#include "ground/measuring/shape_measurer.h"

namespace isotherm {
namespace {

constexpr std::size_t kMaxNameBytes = 200;
constexpr std::size_t kMaxTextBytes = 4000;
constexpr int kMaxCorners = 200;
/// Further from the origin, numbers lose millimetres.
constexpr double kMaxCoordinate_m = 1e4;

bool IsPlace(const measuring::Vector3& v) {
  return std::abs(v.x()) <= kMaxCoordinate_m && std::abs(v.y()) <= kMaxCoordinate_m &&
         std::abs(v.z()) <= kMaxCoordinate_m;
}

bool IsDirection(const measuring::Vector3& v) {
  const double squared = v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
  return squared > 1e-12 && squared < 1e12;
}

struct AnchorCount {
  int min = 0, max = 0;
};
AnchorCount AnchorsOf(measuring::Shape::Kind kind) {
  switch (kind) {
    case measuring::Shape::SPOT:
    case measuring::Shape::NOTE:
      return {1, 1};
    case measuring::Shape::LINE:
    case measuring::Shape::DISTANCE:
      return {2, 2};
    case measuring::Shape::AREA:
      return {3, kMaxCorners};
    default:
      return {0, 0};
  }
}

Status CheckParameters(const measuring::ObjectParameters& parameters) {
  if (parameters.has_emissivity() &&
      !(parameters.emissivity() > 0.0 && parameters.emissivity() <= 1.0))
    return InvalidArgument("the emissivity must be above 0 and at most 1");
  if (parameters.has_film_coefficient_w_m2k() &&
      !(parameters.film_coefficient_w_m2k() >= 0.0 && parameters.film_coefficient_w_m2k() <= 1e5))
    return InvalidArgument("the film coefficient must be 0 to 100000 W/(m2 K)");
  const auto is_temperature = [](double celsius) {
    return celsius >= -273.15 && celsius <= 5000.0;
  };
  if (parameters.has_air_celsius() && !is_temperature(parameters.air_celsius()))
    return InvalidArgument("the temperature of the air is out of range");
  if (parameters.has_reflected_celsius() && !is_temperature(parameters.reflected_celsius()))
    return InvalidArgument("the reflected temperature is out of range");
  return OkStatus();
}

}  // namespace

Status Validate(const measuring::Shape& shape) {
  if (shape.id().empty() || shape.id().size() > kMaxNameBytes)
    return InvalidArgument("a shape needs an id of at most 200 bytes");
  if (shape.name().size() > kMaxNameBytes) return InvalidArgument("the name is too long");
  if (shape.text().size() > kMaxTextBytes) return InvalidArgument("the text is too long");
  if (!measuring::Shape::Kind_IsValid(shape.kind()))
    return InvalidArgument("this kind of shape is not known");
  const AnchorCount count = AnchorsOf(shape.kind());
  if (shape.anchors_size() < count.min || shape.anchors_size() > count.max) {
    return InvalidArgument(fmt::format("this kind of shape has {} to {} points, not {}", count.min,
                                       count.max, shape.anchors_size()));
  }
  for (const measuring::Anchor& anchor : shape.anchors()) {
    if (!IsPlace(anchor.origin()) || !IsDirection(anchor.direction()))
      return InvalidArgument("a point has no usable place or direction");
  }
  return CheckParameters(shape.parameters());
}

}  // namespace isotherm
