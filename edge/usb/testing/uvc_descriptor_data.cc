#include "edge/usb/testing/uvc_descriptor_data.h"

#include <algorithm>
#include <cstddef>

namespace isotherm {
namespace {

using Data = std::vector<std::uint8_t>;

void Append(Data& data, const Data& more) { data.insert(data.end(), more.begin(), more.end()); }
std::uint8_t Low(std::size_t value) { return static_cast<std::uint8_t>(value); }
std::uint8_t High(std::size_t value) { return static_cast<std::uint8_t>(value >> 8); }

/// Puts the length in front.
Data Descriptor(const Data& rest) {
  Data data(rest.size() + 1);
  data[0] = Low(data.size());
  std::copy(rest.begin(), rest.end(), data.begin() + 1);
  return data;
}

Data Interface(int number, int alternate, int endpoints, int subclass) {
  return Descriptor({4, Low(number), Low(alternate), Low(endpoints), 0x0E, Low(subclass), 0, 0});
}

Data Control(const UvcCameraLayout& layout) {
  Data units;
  for (const UvcUnit& unit : layout.units) {
    Data rest = {0x24, 0x06, unit.id};
    rest.insert(rest.end(), unit.guid.begin(), unit.guid.end());
    Append(rest, {8, 1, 1, 1, 0xFF, 0});
    Append(units, Descriptor(rest));
  }
  const std::uint32_t total = static_cast<std::uint32_t>(units.size()) + 13;
  constexpr std::uint32_t kClock = 6'000'000;
  Data data =
      Descriptor({0x24, 0x01, Low(layout.version), High(layout.version), Low(total), High(total),
                  Low(kClock), High(kClock), Low(kClock >> 16), Low(kClock >> 24), 1, 1});
  Append(data, units);
  return data;
}

Data Guid(std::string_view four_characters) {
  Data guid(four_characters.begin(), four_characters.end());
  Append(guid, {0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71});
  return guid;
}

Data Streaming(const UvcCameraLayout& layout) {
  Data data = Descriptor({0x24, 0x01, 1, 0, 0, 0x81, 0, 0, 0, 0, 0, 1, 0});
  Data format = {0x24, 0x04, kEmulatedFormatIndex, Low(layout.sizes.size())};
  Append(format, Guid(layout.four_characters));
  Append(format, {16, 1, 0, 0, 0, 0});
  Append(data, Descriptor(format));
  std::uint8_t index = 0;
  for (const UvcCameraLayout::Size& size : layout.sizes) {
    const auto bytes = static_cast<std::uint32_t>(2 * size.width * size.height);
    const std::uint32_t interval = layout.interval;
    Data frame = {0x24,
                  0x05,
                  ++index,
                  0,
                  Low(size.width),
                  High(size.width),
                  Low(size.height),
                  High(size.height)};
    Append(frame, Data(8));  // Bit rates.
    for (const std::uint32_t value : {bytes, interval}) {
      Append(frame, {Low(value), High(value), Low(value >> 16), Low(value >> 24)});
    }
    Append(frame, {1, Low(interval), High(interval), Low(interval >> 16), Low(interval >> 24)});
    Append(data, Descriptor(frame));
  }
  return data;
}

Data Endpoint(std::uint16_t packet_field, bool bulk) {
  return Descriptor({5, 0x81, Low(bulk ? 2 : 5), Low(packet_field), High(packet_field), 1});
}

}  // namespace

std::vector<std::uint8_t> MakeUvcConfiguration(const UvcCameraLayout& layout) {
  Data data = {9, 2, 0, 0, 2, 1, 0, 0x80, 50};
  Append(data, Interface(0, 0, 0, 1));
  Append(data, Control(layout));
  Append(data, Interface(1, 0, layout.bulk ? 1 : 0, 2));
  Append(data, Streaming(layout));
  if (layout.bulk) Append(data, Endpoint(layout.packet_fields.front(), true));
  int alternate = 0;
  for (const std::uint16_t field : layout.packet_fields) {
    if (layout.bulk) break;
    Append(data, Interface(1, ++alternate, 1, 2));
    Append(data, Endpoint(field, false));
  }
  data[2] = Low(data.size());
  data[3] = High(data.size());
  return data;
}

}  // namespace isotherm
