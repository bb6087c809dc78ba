#pragma once

#include <filesystem>

#include "common/base/status.h"

namespace isotherm {

/// Has OpenNI2's own recorder write at least `frames` frames of the fake camera, 320x240 at 60 Hz,
/// for tests.
Status RecordOni(const std::filesystem::path& file, int frames);

}  // namespace isotherm
