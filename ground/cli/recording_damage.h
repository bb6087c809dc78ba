#pragma once

#include <cstdint>
#include <string>

#include "ground/cli/recording_report.h"

namespace isotherm {

/// Return how many frames were recorded, as far as the file still tells, and cannot be read.
std::uint64_t UnreadDepth(const RecordingReport& report);
std::uint64_t UnreadThermal(const RecordingReport& report);

/// Returns whether there is damage ahead of the end; what follows the last good part may just not
/// have been finished.
bool IsDamaged(const RecordingReport& report);

/// "complete", "DAMAGED; not complete (...)".
std::string StateText(const RecordingReport& report);
/// Lists what is lost and where, a line each; empty if nothing is.
std::string DamageText(const RecordingReport& report);

}  // namespace isotherm
