#include "common/transport/network_addresses.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <memory>
#include <set>

namespace isotherm {
namespace {

/// Returns "wlan0 (3) 192.168.50.1"; nothing for what has no address that counts.
std::string TextOf(const ifaddrs& entry) {
  if (entry.ifa_addr->sa_family != AF_INET) return {};
  const auto& address = reinterpret_cast<const sockaddr_in&>(*entry.ifa_addr);
  std::array<char, INET_ADDRSTRLEN> text{};
  if (::inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size()) == nullptr) return {};
  // One that was pulled out and put back has another number.
  return fmt::format("{} ({}) {}", entry.ifa_name, ::if_nametoindex(entry.ifa_name), text.data());
}

}  // namespace

std::string NetworkAddresses() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> entries(first, &::freeifaddrs);
  std::set<std::string> texts;
  for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || (entry->ifa_flags & IFF_LOOPBACK) != 0) continue;
    if (std::string text = TextOf(*entry); !text.empty()) texts.insert(std::move(text));
  }
  std::string all;
  for (const std::string& text : texts) all += text + "\n";
  return all;
}

}  // namespace isotherm
