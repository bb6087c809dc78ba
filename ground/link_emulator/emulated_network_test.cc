#include "ground/link_emulator/emulated_network.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kPort = 7000;

sockaddr_in Address(const char* address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(kPort);
  ::inet_pton(AF_INET, address, &result.sin_addr);
  return result;
}

/// A socket of a program on one of the two. Thread-compatible.
class UdpSocket {
 public:
  UdpSocket(const EmulatedNetwork& network, NetworkEnd end) {
    // A namespace is a thread's: this one comes back to its own.
    std::thread([&] {
      const FileDescriptor there(
          ::open(network.host(end).network_namespace().c_str(), O_RDONLY | O_CLOEXEC));
      if (::setns(there.get(), CLONE_NEWNET) != 0) return;
      socket_.emplace(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
      const sockaddr_in own =
          Address(EmulatedNetwork::kAddresses.at(static_cast<std::size_t>(end)));
      is_bound_ = ::bind(socket_->get(), reinterpret_cast<const sockaddr*>(&own), sizeof(own)) == 0;
    }).join();
  }
  bool is_bound() const { return is_bound_; }
  void Send(NetworkEnd to, int number) const {
    const sockaddr_in there = Address(EmulatedNetwork::kAddresses.at(static_cast<std::size_t>(to)));
    EXPECT_EQ(::sendto(socket_->get(), &number, sizeof(number), 0,
                       reinterpret_cast<const sockaddr*>(&there), sizeof(there)),
              static_cast<ssize_t>(sizeof(number)));
  }
  /// Nothing if none comes within `timeout`.
  std::optional<int> Receive(std::chrono::milliseconds timeout) const {
    pollfd file{socket_->get(), POLLIN, 0};
    if (::poll(&file, 1, static_cast<int>(timeout.count())) != 1) return std::nullopt;
    int number = 0;
    if (::recv(socket_->get(), &number, sizeof(number), 0) != sizeof(number)) return std::nullopt;
    return number;
  }

 private:
  std::optional<FileDescriptor> socket_;
  bool is_bound_ = false;
};

class EmulatedNetworkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "threads enter network namespaces as root only";
    auto network = EmulatedNetwork::Create(1);
    if (!network) GTEST_SKIP() << "no network of its own: " << network.error().message();
    network_ = std::move(*network);
    edge_.emplace(*network_, NetworkEnd::kEdge);
    ground_.emplace(*network_, NetworkEnd::kGround);
    ASSERT_TRUE(edge_->is_bound());
    ASSERT_TRUE(ground_->is_bound());
  }
  /// Sends packets from the edge. Returns the numbers of those that arrive, in their order.
  std::vector<int> SendAll(int packets) {
    for (int i = 0; i < packets; ++i) edge_->Send(NetworkEnd::kGround, i);
    std::vector<int> arrived;
    while (const auto number = ground_->Receive(1s)) arrived.push_back(*number);
    return arrived;
  }

  std::unique_ptr<EmulatedNetwork> network_;
  std::optional<UdpSocket> edge_, ground_;
};

TEST_F(EmulatedNetworkTest, CarriesPacketsBothWays) {
  edge_->Send(NetworkEnd::kGround, 17);
  EXPECT_EQ(ground_->Receive(10s), 17);
  ground_->Send(NetworkEnd::kEdge, 18);
  EXPECT_EQ(edge_->Receive(10s), 18);
  EXPECT_EQ(network_->counts(NetworkEnd::kEdge).packets, 1U);
  // IPv4 and UDP head, and a number.
  EXPECT_EQ(network_->counts(NetworkEnd::kEdge).bytes, 20U + 8U + 4U);
}

TEST_F(EmulatedNetworkTest, DelaysPackets) {
  network_->SetBoth({.delay = 50ms});
  const auto begin = std::chrono::steady_clock::now();
  edge_->Send(NetworkEnd::kGround, 1);
  ASSERT_TRUE(ground_->Receive(10s).has_value());
  ground_->Send(NetworkEnd::kEdge, 2);
  ASSERT_TRUE(edge_->Receive(10s).has_value());
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 100ms);
}

TEST_F(EmulatedNetworkTest, LosesDoublesAndReordersPacketsAsItCounts) {
  network_->Set(NetworkEnd::kEdge, {.jitter = 20ms, .loss = 0.3, .doubled = 0.3});
  const std::vector<int> arrived = SendAll(200);
  const PathCounts counts = network_->counts(NetworkEnd::kEdge);
  EXPECT_EQ(counts.packets, 200U);
  EXPECT_GT(counts.lost, 0U);
  EXPECT_GT(counts.doubled, 0U);
  EXPECT_EQ(arrived.size(), counts.packets - counts.lost + counts.doubled);
  EXPECT_EQ(std::set(arrived.begin(), arrived.end()).size(), counts.packets - counts.lost);
  EXPECT_FALSE(std::is_sorted(arrived.begin(), arrived.end()));
}

TEST_F(EmulatedNetworkTest, CarriesNothingWhenAllIsLostAndGoesOnAfterwards) {
  network_->SetBoth({.loss = 1.0});
  edge_->Send(NetworkEnd::kGround, 1);
  EXPECT_EQ(ground_->Receive(200ms), std::nullopt);
  network_->SetBoth({});
  edge_->Send(NetworkEnd::kGround, 2);
  EXPECT_EQ(ground_->Receive(10s), 2);
}

TEST(EmulatedHostTest, AnAddressThatIsNoneIsRefused) {
  const auto host = EmulatedHost::Create("rig");
  ASSERT_FALSE(host.has_value());
  EXPECT_EQ(host.error().code(), StatusCode::kInvalidArgument);
}

TEST_F(EmulatedNetworkTest, AHostIsGoneWhateverOthersThereAre) {
  auto first = EmulatedHost::Create("10.0.0.1");
  ASSERT_TRUE(first.has_value()) << first.error().message();
  auto second = EmulatedHost::Create("10.0.0.2");
  ASSERT_TRUE(second.has_value()) << second.error().message();
  const std::filesystem::path name = first->network_namespace();
  { const EmulatedHost gone = std::move(*first); }
  EXPECT_FALSE(std::filesystem::exists(name));
  EXPECT_TRUE(std::filesystem::exists(second->network_namespace()));
}

}  // namespace
}  // namespace isotherm
