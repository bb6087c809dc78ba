#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "common/frame/image.h"
#include "common/radiometry/radiometry.h"
#include "ground/export/json.h"
#include "ground/export/surface.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {

class InterpretationOptions;

/// Checks everything, regions included; the message names the region and the field.
Status Validate(const InterpretationOptions& options);

/// The whole model (first) or a region of it.
struct InterpretedPart {
  std::string name;
  Eigen::AlignedBox3f box_world;  ///< Metres; empty for the whole model.
  double emissivity = 1.0;
  double reflected_celsius = 0.0;
  std::string problem;  ///< Why nothing can be interpreted here; empty if it can.
};

/// Counts how the points of one part fared.
struct PartReport {
  std::size_t points = 0;
  std::size_t measured = 0;           ///< Points with an apparent temperature.
  std::size_t reflects_too_much = 0;  ///< How many of those would reflect more than was measured.
  std::size_t too_hot = 0;            ///< How many of those are beyond the range of temperatures.
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
  /// NaN if `apparent_celsius` is, or if no temperature fits.
  float ObjectCelsius(std::size_t part, float apparent_celsius) const;

  /// Interprets every point; `apparent_celsius` keeps what was measured. One report per part.
  std::vector<PartReport> Apply(Surface& surface) const;
  /// The same for temperatures in a view, whose vertices are `maps` (world).
  void Apply(const SurfaceMaps& maps, Image<float>& celsius) const;

  /// Sentences about regions that overlap.
  std::vector<std::string> Overlaps() const;
  /// One sentence per part in which points have no temperature although they were measured, or
  /// which could not be interpreted.
  std::vector<std::string> Errors(const std::vector<PartReport>& reports) const;
  /// As it goes into stats.json.
  Json Describe(const std::vector<PartReport>& reports) const;

 private:
  explicit Interpretation(const SpectralBand& band) : band_(band) {}
  double EmittedRadiance(const InterpretedPart& part, float apparent_celsius) const;

  BandRadiance band_;
  std::vector<InterpretedPart> parts_;
};

}  // namespace isotherm
