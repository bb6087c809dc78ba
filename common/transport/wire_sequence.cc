#include "common/transport/wire_sequence.h"

#include <dds/dds.h>

namespace isotherm {

void* AllocateZeroed(std::size_t bytes) { return dds_alloc(bytes); }

}  // namespace isotherm
