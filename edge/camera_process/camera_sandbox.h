#pragma once

#include <string>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Holds what the process of a camera needs, so that it can be refused everything else: a vendor's
/// library parses what a device or a file of unknown origin sends.
struct CameraSandbox {
  /// Files, and folders with all that is below them. Paths that do not exist are left out.
  std::vector<std::string> read;
  std::vector<std::string> write;  ///< The same, also to be written; nodes of devices.
  std::vector<std::string> list;   ///< Folders whose names may be read, and nothing below them.
  /// Local sockets: some vendors' libraries talk to a service of theirs.
  bool local_sockets = false;
};

/// Confines this process to `sandbox` for good, with all threads and processes it will start. Call
/// it while there is one thread only. Whatever the sandbox allows, it may neither use a network,
/// start programs, nor signal or inspect other processes.
///
/// The network is kept away by a filter of system calls, not by an empty namespace: in one the
/// kernel's messages that a camera was plugged in would not arrive either. Files are kept away by
/// Landlock.
///
/// Fails if something could not be kept away, and says why; the rest is kept away all the same.
Status EnterSandbox(const CameraSandbox& sandbox);

}  // namespace isotherm
