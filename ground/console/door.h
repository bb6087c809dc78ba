#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "ground/console/access.h"
#include "ground/console/web_server.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// How one comes in: where it listens, whether what is sent is encrypted, and by which codes.
struct Door {
  WebServerOptions server;
  std::optional<AccessTokens> tokens;  ///< nullopt: on this computer only, without codes.
  bool is_secure = false;
  std::string fingerprint;  ///< The certificate's; empty: plain.
  std::string state_dir;

  /// "https://192.168.1.7:8080"; `port` is the one that it listens on.
  std::string Address(int port) const;
  /// The same with a code, as it is in a QR code.
  std::string Address(int port, const std::string& token) const;
};

/// Prepares certificate and codes, if the address is not this computer's own, and keeps them.
Result<Door> PrepareDoor(const GroundOptions& options);

/// Returns whether an address can be reached from this computer only.
bool IsLoopbackAddress(const std::string& address);

/// A QR code for a terminal, two modules per character; empty if the text is too long.
std::string QrText(const std::string& text);

}  // namespace isotherm
