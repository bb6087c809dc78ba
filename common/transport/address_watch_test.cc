#include "common/transport/address_watch.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr const char* kBefore = "eth0 192.168.50.1";
constexpr const char* kAfter = "eth0 192.168.50.77";

TEST(AddressWatchTest, F30AComputerHasMovedOnceItsAddressesAreOthersAndNobodyIsHeard) {
  AddressWatch watch(kBefore);
  const SteadyTime start(1h);
  EXPECT_FALSE(watch.HasMoved(kBefore, 1h, start)) << "the other side is away, no more";
  EXPECT_FALSE(watch.HasMoved(kAfter, 0s, start + 1s));
  EXPECT_FALSE(watch.HasMoved(kAfter, 1s, start + 6s)) << "it is heard all the same";
  EXPECT_TRUE(watch.HasMoved(kAfter, 4s, start + 9s));
}

TEST(AddressWatchTest, F30AnInterfaceThatComesBackChangesNothing) {
  AddressWatch watch(kBefore);
  const SteadyTime start(1h);
  EXPECT_FALSE(watch.HasMoved("", 10s, start));
  EXPECT_FALSE(watch.HasMoved("", 20s, start + 10s)) << "there is nothing to join";
  EXPECT_FALSE(watch.HasMoved(kBefore, 20s, start + 11s));
  EXPECT_FALSE(watch.HasMoved(kAfter, 22s, start + 12s)) << "it differs since now";
  EXPECT_TRUE(watch.HasMoved(kAfter, 26s, start + 16s));
}

}  // namespace
}  // namespace isotherm
