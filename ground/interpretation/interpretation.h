#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "common/frame/image.h"
#include "common/radiometry/radiometry.h"
#include "ground/json/json.h"
#include "ground/mesh/surface.h"
#include "ground/renderer/view_maps.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {

class InterpretationOptions;

/// Checks everything, regions included; the message names the region and the field.
Status Validate(const InterpretationOptions& options);

/// The whole model (first) or a region of it.
struct InterpretedPart {
  std::string name;
  Eigen::AlignedBox3f box_world;  ///< Metres; empty for the whole model.
  double emissivity = 1.0;        ///< Along the normal.
  double reflected_celsius = 0.0;
  std::string
      material;  ///< Its emissivity depends on the angle like this one's; empty: it does not.
  double emissivity_sigma = 0.0, reflected_sigma_k = 0.0;  ///< Standard uncertainties.
  /// Emissivity by whole degree of the angle, as a ratio to that along the normal; empty: 1.
  std::vector<float> by_angle{};
  std::string problem;  ///< Why nothing can be interpreted here; empty if it can.
};

/// Counts how the points of one part fared.
struct PartReport {
  std::size_t points = 0;
  std::size_t measured = 0;           ///< Points with an apparent temperature.
  std::size_t reflects_too_much = 0;  ///< How many of those would reflect more than was measured.
  std::size_t too_hot = 0;            ///< How many of those are beyond the range of temperatures.
  /// How many of the measured ones have no angle that a material needs: taken as along the normal.
  std::size_t without_angle = 0;
  /// Apparent temperatures of the points without a solution.
  float coldest_celsius = 0.0F, hottest_celsius = 0.0F;

  std::size_t unsolved() const { return reflects_too_much + too_hot; }
};

/// Turns apparent temperatures into those of the objects (thesis eq. 3.1 over the camera's band,
/// surroundings of one temperature) after a scan, with an emissivity and a reflected temperature
/// for the whole model and for boxes in it. Where boxes overlap, the later one holds. Immutable.
class Interpretation {
 public:
  /// Refuses wrong values for the whole model and boxes that are none. Regions with other wrong
  /// values are kept with their `problem`; their points get no temperature.
  static Result<Interpretation> Create(const InterpretationOptions& options);

  /// Emissivity 1 everywhere: object temperatures are the apparent ones.
  bool changes_nothing() const;
  const std::vector<InterpretedPart>& parts() const { return parts_; }
  /// Index in parts() of the one that holds at a point.
  std::size_t PartAt(const Eigen::Vector3f& p_world) const;
  /// NaN if `apparent_celsius` is, or if no temperature fits. `angle_deg`: between the normal and
  /// the line of sight of the measurement; NaN is taken as along the normal.
  float ObjectCelsius(std::size_t part, float apparent_celsius, float angle_deg = NAN) const;
  /// The standard uncertainty of that, kelvin, from `apparent_sigma_k` and those of the part's
  /// emissivity and reflected temperature, to first order (GUM 5.1.2). NaN if the temperature or
  /// `apparent_sigma_k` is.
  float ObjectSigma(std::size_t part, float apparent_celsius, float apparent_sigma_k,
                    float angle_deg = NAN) const;

  /// Interprets every point; `apparent_celsius` keeps what was measured. One report per part.
  std::vector<PartReport> Apply(Surface& surface) const;
  /// The same for a view with records, whose vertices are `maps` (world).
  void Apply(const SurfaceMaps& maps, ViewMaps& view) const;
  /// The same for other temperatures in it.
  void Apply(const SurfaceMaps& maps, const ViewMaps& view, Image<float>& celsius) const;

  /// Sentences about regions that overlap.
  std::vector<std::string> Overlaps() const;
  /// One sentence per part in which points have no temperature although they were measured, or
  /// which could not be interpreted.
  std::vector<std::string> Errors(const std::vector<PartReport>& reports) const;
  /// Returns what goes into stats.json.
  Json Describe(const std::vector<PartReport>& reports) const;

 private:
  explicit Interpretation(const SpectralBand& band) : band_(band) {}
  double EmittedRadiance(const InterpretedPart& part, float apparent_celsius,
                         float angle_deg) const;

  BandRadiance band_;
  std::vector<InterpretedPart> parts_;
};

}  // namespace isotherm
