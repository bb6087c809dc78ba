#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/file_descriptor.h"
#include "common/base/status.h"

namespace isotherm {

/// A computer that is none: a network namespace of this one, with an interface whose packets this
/// process carries. Programs are started on it by CommandPrefix(). It takes root, or a kernel that
/// gives user namespaces and /dev/net/tun to everybody. It is gone with this object, or with the
/// thread that made it. Thread-compatible.
class EmulatedHost {
 public:
  /// Name of the interface.
  static constexpr const char* kInterface = "air0";

  /// `address` is the interface's, in a network of 24 bits, for example "192.168.50.1".
  static Result<EmulatedHost> Create(const std::string& address);
  EmulatedHost(EmulatedHost&& other) noexcept;
  EmulatedHost& operator=(EmulatedHost&&) = delete;
  ~EmulatedHost();

  /// Returns what to put before a program and its arguments so that it runs there; the first word
  /// is a program.
  std::vector<std::string> CommandPrefix() const;
  /// Reading gives the next packet that a program there sends (IPv4, without a link's header),
  /// writing brings one there. Does not block.
  int packets() const { return packets_.get(); }
  /// Its network namespace, for setns().
  std::filesystem::path network_namespace() const;

 private:
  EmulatedHost(pid_t keeper, FileDescriptor control, FileDescriptor packets)
      : keeper_(keeper), control_(std::move(control)), packets_(std::move(packets)) {}

  pid_t keeper_;            ///< The process that keeps the namespaces alive.
  FileDescriptor control_;  ///< The keeper ends when it is closed.
  FileDescriptor packets_;
};

}  // namespace isotherm
