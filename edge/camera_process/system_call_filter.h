#pragma once

#include "common/base/status.h"

namespace isotherm {

/// Refuses system calls to this process, for good, that no driver of a camera needs: sockets (but
/// for the kernel's messages about devices and, if `local_sockets`, local ones), starting programs,
/// signals to others, looking into other processes, mounting, and kernel facilities that do the
/// same by another way. They fail with an error; nothing is ended. Needs PR_SET_NO_NEW_PRIVS.
Status FilterSystemCalls(bool local_sockets);

}  // namespace isotherm
