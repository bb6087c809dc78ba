#include "common/transport/one_way_watch.h"

#include <gtest/gtest.h>

#include <set>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr PeerHandle kFirst = 1;
constexpr PeerHandle kSecond = 2;

class OneWayWatchTest : public ::testing::Test {
 protected:
  /// Looks for so long; returns the host of the one that is not heard at the end.
  std::string Look(Nanoseconds duration) {
    std::optional<Announcement> silent;
    for (const SteadyTime end = now_ + duration; now_ < end; now_ += 100ms)
      silent = watch_.Look(now_, announced_, [this](PeerHandle p) { return heard_.contains(p); });
    return silent ? silent->host : "";
  }

  SteadyTime now_{1h};
  std::map<PeerHandle, Announcement> announced_;
  std::set<PeerHandle> heard_;
  OneWayWatch watch_;
};

TEST_F(OneWayWatchTest, F29WhoIsAnnouncedAndNotHeardIsNamedAfterFiveSeconds) {
  announced_[kFirst] = {Role::kGround, "", "desk"};
  EXPECT_EQ(Look(4s), "");
  EXPECT_EQ(Look(2s), "desk");
  heard_.insert(kFirst);
  EXPECT_EQ(Look(200ms), "");
}

TEST_F(OneWayWatchTest, F29WhoWasKilledIsNoSilentPeer) {
  announced_[kFirst] = {Role::kGround, "", "desk"};
  heard_.insert(kFirst);
  Look(10s);
  heard_.clear();
  EXPECT_EQ(Look(11s), "") << "the middleware's lease";
  announced_.clear();
  EXPECT_EQ(Look(10s), "");
}

TEST_F(OneWayWatchTest, F29WhoWasHeardAndGoesOnAnnouncingItselfIsOne) {
  announced_[kFirst] = {Role::kGround, "", "desk"};
  announced_[kSecond] = {Role::kGround, "", "other"};
  heard_ = {kFirst, kSecond};
  Look(10s);
  heard_ = {kSecond};
  EXPECT_EQ(Look(16s), "desk");
}

TEST_F(OneWayWatchTest, F29WhoComesBackAfterAnOutageIsGivenTime) {
  announced_[kFirst] = {Role::kGround, "", "desk"};
  heard_.insert(kFirst);
  Look(10s);
  heard_.clear();
  announced_.clear();
  Look(60s);
  announced_[kFirst] = {Role::kGround, "", "desk"};
  EXPECT_EQ(Look(10s), "");
  EXPECT_EQ(Look(6s), "desk");
}

TEST_F(OneWayWatchTest, F29WhoSpeaksAnotherVersionIsHeard) {
  announced_[kFirst] = {Role::kGround, "", "desk"};
  watch_.OnHeard(kFirst);
  EXPECT_EQ(Look(30s), "");
}

TEST(AnnouncementTest, IsReadAsItWasWritten) {
  for (const Announcement& announcement :
       {Announcement{Role::kEdge, "drone-2", "raspi"}, Announcement{Role::kGround, "", "desk"}}) {
    EXPECT_EQ(ParseAnnouncement(ToText(announcement)), announcement) << ToText(announcement);
  }
}

TEST(AnnouncementTest, OthersAreNone) {
  for (const char* const text :
       {"", "isotherm-edge", "isotherm-edge drone", "rviz drone@desk", "isotherm-ground"}) {
    EXPECT_EQ(ParseAnnouncement(text), std::nullopt) << text;
  }
  EXPECT_EQ(ParseAnnouncement("isotherm-edge @" + std::string(200, 'x')), std::nullopt);
  const auto hostile = ParseAnnouncement("isotherm-edge a\x1b[2J@\n");
  ASSERT_TRUE(hostile);
  EXPECT_EQ(hostile->name, "a?[2J");
  EXPECT_EQ(hostile->host, "?");
  EXPECT_LE(ToText({Role::kEdge, std::string(500, 'x'), "y"}).size(), 128U);
}

}  // namespace
}  // namespace isotherm
