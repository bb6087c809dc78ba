#pragma once

#include <string>

#include "ground/json/json.h"
#include "ground/service/recording_tracker.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// Describes what became of a session's frames, how soon feedback reached the edge and how good the
/// rig's clock was, as it goes into stats.json.
void DescribeCounters(const SessionCounters& counters, const RecordingProgress& recording,
                      Json& link);

/// The same for the user: a line per stream, one about feedback if its age is known, one about the
/// clock.
std::string CountersText(const SessionCounters& counters, const RecordingProgress& recording);

}  // namespace isotherm
