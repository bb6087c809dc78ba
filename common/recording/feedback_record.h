#pragma once

#include <optional>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/recording/recording.h"

namespace isotherm {

/// Feedback lies in a recording under the first name, its images beside it under the second.
inline constexpr std::string_view kFeedbackRecordTopic = "/feedback";
inline constexpr std::string_view kFeedbackImageTopic = "/feedback/image";

/// Records feedback at the capture time of the depth frame that it is about, so that it belongs to
/// the time base of the frames even in a replay. `arrival`: when it reached the edge, for the
/// edge's own recording. `newest`: of the frames recorded so far; feedback lies there if it is
/// about an older one, because a message that goes back in time ends a chunk of the recording.
Status WriteFeedback(const Feedback& feedback, const std::optional<CaptureTime>& arrival,
                     RecordingWriter& writer,
                     const std::optional<CaptureTime>& newest = std::nullopt);

}  // namespace isotherm
