#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

namespace isotherm {

/// Says what a process of a camera tries when its library is hostile, for tests. The order is that
/// of ProbeSandbox's results.
enum class SandboxAttempt {
  kInternetSocket,
  kInternetDatagrams,
  kLocalSocket,
  kRouteSocket,   ///< The kernel's messages about the network.
  kDeviceSocket,  ///< Asks the kernel about devices.
  kReadForeign,
  kWriteForeign,
  kCreateFile,
  kReadAllowed,
  kWriteAllowed,
  kReadParent,  ///< Reads what the kernel says of the process that started it.
  kSignalParent,
  kStartProgram,
  kIoRing,
  kCount
};

using SandboxResults = std::array<std::uint16_t, static_cast<std::size_t>(SandboxAttempt::kCount)>;

/// Tries all with the files `foreign`, `allowed` and `new` of `folder`; 0 where it was done, else
/// the error number.
SandboxResults ProbeSandbox(const std::filesystem::path& folder);

/// Makes this process die of a request for Landlock, as a service's filter of system calls does it.
void ForbidLandlock();

}  // namespace isotherm
