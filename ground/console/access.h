#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "ground/console/live.pb.h"
#include "ground/console/web_server.h"

namespace isotherm {

/// The codes by which people come in from other computers: whoever has one of them may look, or
/// give orders.
struct AccessTokens {
  std::string viewer, operator_token;
};

/// Random text of so many bits, in letters and digits that are not taken for each other.
std::string RandomToken(int bits);
/// Takes as long wherever they differ.
bool IsSameSecret(std::string_view a, std::string_view b);

/// Says who may do what. On loopback everybody who is on this computer is the operator; from
/// elsewhere a token gives a session, which a cookie names that scripts cannot read and other sites
/// cannot send. Thread-bound to the I/O thread.
class Access {
 public:
  /// Without tokens: loopback.
  Access(const Clock& clock, std::optional<AccessTokens> tokens, bool is_secure)
      : clock_(clock), tokens_(std::move(tokens)), is_secure_(is_secure) {}

  /// Says why a request is not answered at all: a name that is not this host's, a page of another
  /// host.
  std::optional<WebReply> Refusal(const WebRequest& request) const;
  /// Returns what the one who asks may do; nullopt: nothing, until they have logged in.
  std::optional<live::Role> RoleOf(const WebRequest& request) const;
  /// POST /api/login with the token as body.
  WebReply LogIn(const WebRequest& request);
  bool is_open() const { return !tokens_.has_value(); }

 private:
  struct Session {
    live::Role role = live::VIEWER;
    SteadyTime begun;
  };
  std::optional<live::Role> RoleOfToken(std::string_view token) const;
  /// Wrong tokens of late delay the next answer.
  bool IsTooSoon();

  const Clock& clock_;
  const std::optional<AccessTokens> tokens_;
  const bool is_secure_;
  std::map<std::string, Session, std::less<>> sessions_;
  int wrong_ = 0;
  SteadyTime not_before_{};
};

/// The name of a Host or Origin without scheme and port: "[::1]" of "http://[::1]:8080".
std::string_view HostName(std::string_view host_or_origin);
bool IsLoopbackName(std::string_view name);
/// The value of a cookie; empty if there is none.
std::string_view CookieValue(std::string_view header, std::string_view name);

}  // namespace isotherm
