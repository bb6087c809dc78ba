#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <thread>

#include "common/base/mutex.h"

namespace isotherm::system_test {

/// How busy others keep this computer: other programs and, on a virtual machine, its host. From the
/// kernel's count of processor time, of which that of this process and all its descendants is
/// taken off: a program that is tested never makes its own excuse. Measured from its construction
/// on. Thread-safe.
///
/// It may excuse times and fractions of a processor. It excuses no frame that nobody counted.
class MachineLoad {
 public:
  MachineLoad();

  /// The fraction of all processors that others took, 0..1, since the construction.
  double others_fraction() const;
  /// The same in the worst whole second; 0 within the first, since of a few ticks nothing follows.
  double worst_others_fraction() const;
  /// Others left so little that lateness and losses by lateness tell nothing.
  bool is_busy() const;
  /// Returns the part of all frames that may be lost because of others, 0..1: none unless they kept
  /// the computer busy, then no more than they took on average, and never more than a quarter,
  /// since the programs need less than what is left.
  double excused_fraction() const;
  /// Returns those figures, for people.
  std::string ToText() const;

 private:
  /// In ticks of the kernel's clock.
  struct ProcessorTime {
    std::uint64_t all = 0;   ///< Ticks of all processors, idle or not.
    std::uint64_t busy = 0;  ///< Including what the host took.
    std::uint64_t own = 0;
  };
  static ProcessorTime Read();
  static double OthersFraction(const ProcessorTime& from, const ProcessorTime& to);
  void Watch(const std::stop_token& stop);

  const ProcessorTime start_;
  mutable Mutex mutex_;
  double worst_ GUARDED_BY(mutex_) = 0.0;
  std::jthread thread_;
};

}  // namespace isotherm::system_test
