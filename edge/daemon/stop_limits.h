#pragma once

#include "common/base/exit_deadline.h"
#include "common/time/time_types.h"
#include "common/transport/qos.h"
#include "edge/publisher/stop_budget.h"

namespace isotherm {

/// These say how long the parts of an edge may take to end once it was told to leave. With healthy
/// cameras and a disk that answers, it leaves within two seconds in every state of the link;
/// whatever hangs, it leaves within kMaxStop.
namespace stop_limits {

using std::chrono::milliseconds;

/// The main thread looks around this often.
inline constexpr Nanoseconds kTick = milliseconds(50);
/// Time to let the ground confirm the last frames when a signal says to leave.
inline constexpr Nanoseconds kLingerAfterSignal = milliseconds(500);

/// The cameras end first. A vendor's process is given one second of this before it is killed.
inline constexpr Nanoseconds kCameras = milliseconds(1750);
/// The recording is closed next; a disk may take this long to answer.
inline constexpr Nanoseconds kDisk = milliseconds(3500);
/// The link takes no more than this by itself if nothing in it hangs: the frames under way, the
/// last status and the ground's confirmation, for which it is asked once a tick.
inline constexpr Nanoseconds kLink =
    StopBudget::kMaxTotal + kMaxMessageBlocking + kLingerAfterSignal + kTick;
/// The middleware ends last; with its network interface down it never does by itself.
inline constexpr Nanoseconds kMiddleware = milliseconds(400);

/// From the signal on, for all of them together: they cannot add up.
inline constexpr Nanoseconds kTotal = milliseconds(7000);
/// The last words before something is left behind come on top.
inline constexpr Nanoseconds kMaxStop = kTotal + ExitDeadline::kTimeForLastWords;
/// The edge promises this while cameras and disk end at once, whatever the link does.
inline constexpr Nanoseconds kPromise = milliseconds(2000);

static_assert(kTick + kLink + kMiddleware < kPromise, "also with the middleware left behind");
static_assert(kTick + kLink + ExitDeadline::kTimeForLastWords < kPromise);
static_assert(kTick + kCameras + kDisk < kTotal, "the disk gets its time behind slow cameras");
static_assert(kMaxStop <= milliseconds(8000));

}  // namespace stop_limits
}  // namespace isotherm
