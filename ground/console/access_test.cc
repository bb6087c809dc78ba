#include "ground/console/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

WebRequest Request(const std::string& host, const std::string& origin = "") {
  WebRequest request;
  request.method = "GET";
  request.host = host;
  request.origin = origin;
  return request;
}

class AccessTest : public ::testing::Test {
 protected:
  WebReply LogIn(Access& access, const std::string& token) {
    WebRequest request = Request("rig.local:8443");
    request.method = "POST";
    request.body = token;
    return access.LogIn(request);
  }
  static std::string CookieOf(const WebReply& reply) {
    for (const auto& [name, value] : reply.headers) {
      if (name == "Set-Cookie") return value.substr(0, value.find(';'));
    }
    return "";
  }
  FakeClock clock_;
  Access loopback_{clock_, std::nullopt, false};
  Access remote_{clock_, AccessTokens{"view-me", "order-me"}, true};
};

TEST_F(AccessTest, WhoIsOnThisComputerIsTheOperator) {
  EXPECT_EQ(loopback_.RoleOf(Request("127.0.0.1:8080")), live::OPERATOR);
}

TEST_F(AccessTest, OnLoopbackOnlyItsOwnNamesAreServed) {
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080", "localhost"})
    EXPECT_FALSE(loopback_.Refusal(Request(host))) << host;
  for (const char* host : {"evil.example:8080", "", "127.0.0.1.evil.example", "10.0.0.1"})
    EXPECT_EQ(loopback_.Refusal(Request(host))->status, 421) << host;
}

TEST_F(AccessTest, PagesOfOtherHostsAreRefused) {
  EXPECT_FALSE(loopback_.Refusal(Request("localhost:8080", "http://localhost:8080")));
  for (const char* origin : {"http://evil.example", "http://localhost:9", "https://localhost:8080",
                             "null", "http://127.0.0.1:8080"})
    EXPECT_EQ(loopback_.Refusal(Request("localhost:8080", origin))->status, 403) << origin;
}

TEST_F(AccessTest, FromElsewhereNobodyIsServedWithoutASession) {
  EXPECT_FALSE(remote_.Refusal(Request("rig.local:8443", "https://rig.local:8443")));
  EXPECT_FALSE(remote_.RoleOf(Request("rig.local:8443")));
  WebRequest forged = Request("rig.local:8443");
  forged.cookie = "isotherm_session=order-me";
  EXPECT_FALSE(remote_.RoleOf(forged));
}

TEST_F(AccessTest, ATokenGivesASessionWithItsRole) {
  for (const auto& [token, role] :
       {std::pair("view-me", live::VIEWER), std::pair("order-me", live::OPERATOR)}) {
    const WebReply reply = LogIn(remote_, token);
    EXPECT_EQ(reply.status, 200);
    WebRequest request = Request("rig.local:8443");
    request.cookie = "other=1; " + CookieOf(reply);
    EXPECT_EQ(remote_.RoleOf(request), role);
  }
}

TEST_F(AccessTest, TheCookieIsOutOfReachOfScriptsAndOtherSites) {
  for (const auto& [name, value] : LogIn(remote_, "order-me").headers) {
    if (name != "Set-Cookie") continue;
    EXPECT_THAT(value, HasSubstr("HttpOnly"));
    EXPECT_THAT(value, HasSubstr("SameSite=Strict"));
    EXPECT_THAT(value, HasSubstr("Secure"));
  }
}

TEST_F(AccessTest, ASessionEnds) {
  WebRequest request = Request("rig.local:8443");
  request.cookie = CookieOf(LogIn(remote_, "view-me"));
  clock_.Advance(29 * 24h);
  EXPECT_TRUE(remote_.RoleOf(request));
  clock_.Advance(2 * 24h);
  EXPECT_FALSE(remote_.RoleOf(request));
}

TEST_F(AccessTest, WrongTokensAreRefusedAndSlowTheNextOnesDown) {
  for (int i = 0; i < 6; ++i) EXPECT_EQ(LogIn(remote_, "guess").status, 401);
  EXPECT_EQ(LogIn(remote_, "order-me").status, 429);
  clock_.Advance(3s);
  EXPECT_EQ(LogIn(remote_, "order-me").status, 200);
}

TEST_F(AccessTest, AProgramMaySendItsTokenWithEachRequest) {
  WebRequest request = Request("rig.local:8443");
  request.authorization = "Bearer view-me";
  EXPECT_EQ(remote_.RoleOf(request), live::VIEWER);
  request.authorization = "Bearer view-me ";
  EXPECT_FALSE(remote_.RoleOf(request));
}

TEST_F(AccessTest, TokensAreLongEnoughAndDiffer) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(RandomToken(128));
  EXPECT_EQ(tokens.size(), 100U);
  EXPECT_GE(tokens.begin()->size(), 26U);
}

TEST_F(AccessTest, CookiesAreFoundByTheirWholeName) {
  EXPECT_EQ(CookieValue("a=1; bb=2; b=3", "b"), "3");
  EXPECT_EQ(CookieValue("xb=1", "b"), "");
  EXPECT_EQ(CookieValue("b", "b"), "");
  EXPECT_EQ(CookieValue("", "b"), "");
}

}  // namespace
}  // namespace isotherm
