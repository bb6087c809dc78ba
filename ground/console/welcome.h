#pragma once

#include "ground/console/live.pb.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// The tables that a page needs to colour and interpret temperatures by itself.
live::Welcome MakeWelcome(const GroundOptions& options);

}  // namespace isotherm
