#include "common/transport/messages.h"

#include <fmt/format.h>

namespace isotherm {
namespace {

std::string_view NameOf(Role role) { return role == Role::kEdge ? "edge" : "ground"; }

std::string Describe(const Hello& hello) {
  return fmt::format("the {} on {} (version {}) speaks wire {}.{}", NameOf(hello.role),
                     hello.host.empty() ? "an unnamed computer" : hello.host,
                     hello.software_version.empty() ? "unknown" : hello.software_version,
                     hello.wire_major, hello.wire_minor);
}

}  // namespace

Status CheckCompatible(const Hello& own, const Hello& peer) {
  if (own.wire_major == peer.wire_major) return OkStatus();
  const Hello& old = own.wire_major < peer.wire_major ? own : peer;
  return FailedPrecondition(
      fmt::format("{}, {}: update the {}", Describe(own), Describe(peer), NameOf(old.role)));
}

}  // namespace isotherm
