#pragma once

#include <optional>

#include "common/frame/frame.h"

namespace isotherm {

/// Holds what the state of the correction at one frame is decided by.
struct NucFacts {
  std::optional<CameraNuc> camera{};  ///< The camera's own report.
  bool is_stuck = false;              ///< The shutter, or frozen images, for too long.
  bool is_closed = false;             ///< The shutter.
  bool is_settling = false;           ///< Open for less than the settle time.
  bool is_ordered = false;            ///< Ordered, and the shutter has not closed yet.
  bool is_given_up = false;           ///< Due, but the camera has not followed any attempt.
  bool waits_for_first = false;       ///< Nothing is valid before the first correction.
  bool waits_for_warm_up = false;     ///< Nothing is valid before the camera is warm.
  bool is_due = false;                ///< A correction is wanted.
  bool is_shutter_reported = false;   ///< The camera says when its shutter is closed.
};

/// Returns the state that follows from `facts`: that of the first row of a table that applies.
NucState StateFrom(const NucFacts& facts);

/// Returns whether temperatures of a frame in `state` may reach the model.
bool IsValid(NucState state, const NucFacts& facts);

}  // namespace isotherm
