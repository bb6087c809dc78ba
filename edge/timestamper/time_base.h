#pragma once

#include <cstdint>

namespace isotherm {

class SourceOptions;

/// Says how capture times relate to the edge's wall clock.
enum class TimeBase : std::uint8_t {
  kWallClock,  ///< Capture times are on it.
  kShifted,    ///< A recording's own, played in real time: off by a constant that is not known.
  kOther,      ///< They pass at another pace.
};

/// The time base of the frames that such a source gives.
TimeBase TimeBaseOf(const SourceOptions& options);

}  // namespace isotherm
