#pragma once

#include <string>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// A depth camera that OpenNI2 can see.
struct OpenniListing {
  std::string uri;
  std::string model;
  std::string serial;              ///< Empty: it does not say.
  std::vector<std::string> modes;  ///< "640x480@30 1 mm".
  std::string problem;             ///< Why it cannot be opened; empty if it can.
};

/// The depth cameras connected now. Opens each for its serial number and modes.
Result<std::vector<OpenniListing>> ListOpenniCameras();

}  // namespace isotherm
