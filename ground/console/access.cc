#include "ground/console/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "ground/console/text_reply.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kCookie = "isotherm_session";
constexpr int kSessionBits = 160;
constexpr std::size_t kMaxSessions = 256;
constexpr Nanoseconds kSessionLasts = 30 * 24h;
/// So many wrong tokens cost nothing; then each one doubles the pause.
constexpr int kFreeMistakes = 5;
constexpr int kMaxDoublings = 6;  // About a minute.

}  // namespace

std::string RandomToken(int bits) {
  constexpr std::string_view kLetters = "abcdefghjkmnpqrstuvwxyz23456789";  // No i, l, o, 0, 1.
  constexpr double kBitsPerLetter = 4.95;
  std::random_device random;  // The kernel's generator.
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  std::string token;
  while (static_cast<double>(token.size()) * kBitsPerLetter < bits)
    token.push_back(kLetters[letter(random)]);
  return token;
}

bool IsSameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return different == 0;
}

std::string_view HostName(std::string_view host) {
  if (const std::size_t scheme = host.find("://"); scheme != std::string_view::npos)
    host.remove_prefix(scheme + 3);
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos) return host;
  if (bracket != std::string_view::npos && colon < bracket) return host;
  return host.substr(0, colon);
}

bool IsLoopbackName(std::string_view name) {
  constexpr std::array<std::string_view, 3> kNames = {"127.0.0.1", "localhost", "[::1]"};
  return std::ranges::find(kNames, name) != kNames.end();
}

std::string_view CookieValue(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = header.find(';');
    std::string_view pair = header.substr(0, end);
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name)
      return pair.substr(equals + 1);
    if (end == std::string_view::npos) break;
    header.remove_prefix(end + 1);
  }
  return {};
}

std::optional<WebReply> Access::Refusal(const WebRequest& request) const {
  // A page of another host that has this one's address (DNS rebinding) calls it by its own name.
  if (is_open() && !IsLoopbackName(HostName(request.host)))
    return TextReply(421, "this host is not served under that name\n");
  const std::string own = (is_secure_ ? "https://" : "http://") + request.host;
  if (!request.origin.empty() && request.origin != own)
    return TextReply(403, "pages of other hosts are not served\n");
  return std::nullopt;
}

std::optional<live::Role> Access::RoleOfToken(std::string_view token) const {
  if (!tokens_) return live::OPERATOR;
  if (IsSameSecret(token, tokens_->operator_token)) return live::OPERATOR;
  if (IsSameSecret(token, tokens_->viewer)) return live::VIEWER;
  return std::nullopt;
}

std::optional<live::Role> Access::RoleOf(const WebRequest& request) const {
  if (is_open()) return live::OPERATOR;
  constexpr std::string_view kBearer = "Bearer ";
  if (request.authorization.starts_with(kBearer))
    return RoleOfToken(std::string_view(request.authorization).substr(kBearer.size()));
  const auto session = sessions_.find(CookieValue(request.cookie, kCookie));
  if (session == sessions_.end() || clock_.SteadyNow() - session->second.begun > kSessionLasts)
    return std::nullopt;
  return session->second.role;
}

bool Access::IsTooSoon() { return clock_.SteadyNow() < not_before_; }

WebReply Access::LogIn(const WebRequest& request) {
  if (request.method != "POST") return TextReply(405, "the code is sent by POST\n");
  if (IsTooSoon()) return TextReply(429, "too many wrong codes: wait a little\n");
  const std::optional<live::Role> role = RoleOfToken(request.body);
  if (!role) {
    if (++wrong_ > kFreeMistakes) {
      const int doublings = std::min(kMaxDoublings, wrong_ - kFreeMistakes);
      not_before_ = clock_.SteadyNow() + std::chrono::seconds(1 << doublings);
    }
    return TextReply(401, "this code is not known\n");
  }
  wrong_ = 0;
  if (sessions_.size() >= kMaxSessions) {
    sessions_.erase(std::ranges::min_element(
        sessions_, {}, [](const auto& session) { return session.second.begun; }));
  }
  const std::string id = RandomToken(kSessionBits);
  sessions_[id] = {*role, clock_.SteadyNow()};
  WebReply reply = TextReply(200, *role == live::OPERATOR ? "operator\n" : "viewer\n");
  reply.headers.emplace_back(
      "Set-Cookie",
      fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict; Max-Age={}{}", kCookie, id,
                  std::chrono::duration_cast<std::chrono::seconds>(kSessionLasts).count(),
                  is_secure_ ? "; Secure" : ""));
  return reply;
}

}  // namespace isotherm
