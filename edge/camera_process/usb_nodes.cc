#include "edge/camera_process/usb_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <system_error>

namespace isotherm {
namespace {

namespace fs = std::filesystem;

/// The number in a file of one line; nullopt if there is none.
std::optional<int> ReadNumber(const fs::path& path, int base) {
  std::ifstream file(path);
  std::string text;
  if (!std::getline(file, text)) return std::nullopt;
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, base);
  if (end == text.c_str()) return std::nullopt;
  return static_cast<int>(value);
}

std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    entries.push_back(entry.path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

void AddInterface(const fs::path& interface, UsbNode& node) {
  for (const fs::path& video : EntriesOf(interface / "video4linux")) {
    node.paths.push_back("/dev/" + video.filename().string());
  }
}

}  // namespace

std::vector<UsbNode> ListUsbNodes(const fs::path& devices) {
  std::vector<UsbNode> nodes;
  for (const fs::path& device : EntriesOf(devices)) {
    const std::optional<int> vendor = ReadNumber(device / "idVendor", 16);
    const std::optional<int> product = ReadNumber(device / "idProduct", 16);
    const std::optional<int> bus = ReadNumber(device / "busnum", 10);
    const std::optional<int> number = ReadNumber(device / "devnum", 10);
    if (!vendor || !product || !bus || !number) continue;
    UsbNode node;
    node.vendor_id = static_cast<std::uint16_t>(*vendor);
    node.product_id = static_cast<std::uint16_t>(*product);
    node.paths.push_back(fmt::format("/dev/bus/usb/{:03}/{:03}", *bus, *number));
    for (const fs::path& entry : EntriesOf(device)) AddInterface(entry, node);
    nodes.push_back(std::move(node));
  }
  return nodes;
}

}  // namespace isotherm
