#pragma once

#include <memory>

#include "common/base/status.h"
#include "edge/daemon/make_source.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class EdgeOptions;

/// Opens the source that the options ask for. Cameras that are not there are waited for, as a
/// service does, and the service manager is told so; not with --exit-at-end, whose caller has to
/// know. An attempt that does not come back is no sign of life: the service manager is left to end
/// it.
Result<std::unique_ptr<FrameSource>> OpenSource(const EdgeOptions& options,
                                                const SourceContext& context);

}  // namespace isotherm
