#pragma once

#include <functional>

namespace isotherm {

/// Tells `whole` the progress of a part of a job, from fraction `from` to fraction `to` of it.
/// `whole`, which may be empty, must outlive it.
inline std::function<void(double)> PartOf(const std::function<void(double)>& whole, double from,
                                          double to) {
  return [&whole, from, to](double done) {
    if (whole) whole(from + (to - from) * done);
  };
}

}  // namespace isotherm
