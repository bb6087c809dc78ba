#pragma once

#include <limits>

struct timex;

namespace isotherm {

/// Holds what the kernel knows about the wall clock; time synchronisation (chrony) keeps it
/// current.
struct KernelClock {
  bool synchronised = false;
  double offset_s = std::numeric_limits<double>::quiet_NaN();  ///< Still being corrected.
  double estimated_error_s = std::numeric_limits<double>::quiet_NaN();
  double max_error_s =
      std::numeric_limits<double>::quiet_NaN();  ///< Bound. NaN while unsynchronised.
};

/// Asks the kernel (adjtimex, read only).
KernelClock ReadKernelClock();

/// Returns what its answer means; `state` is what the call returned.
KernelClock Interpret(const timex& answer, int state);

}  // namespace isotherm
