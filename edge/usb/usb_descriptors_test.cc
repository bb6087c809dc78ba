#include "edge/usb/usb_descriptors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "common/testing/guarded_buffer.h"
#include "edge/usb/uvc_descriptors.h"
#include "edge/usb/uvc_probe.h"

namespace isotherm {
namespace {

using Data = std::vector<std::uint8_t>;

/// A camera as the tables of the class specification lay it out, byte by byte.
Data Camera() {
  Data data = {
      9, 2, 0, 0, 2, 1, 0, 0x80, 50,  // Configuration 1; the total is filled
                                      // in below.
      9, 4, 0, 0, 0, 0x0E, 1, 0, 0,   // Interface 0: video control.
      13, 0x24, 1, 0x00, 0x01, 39, 0, 0x80, 0x8D, 0x5B, 0x00, 1, 1,  // UVC 1.00, 6
                                                                     // MHz.
      26, 0x24, 6, 5,                                                // Extension unit 5, ...
      'p', 't', '1', '-', 'l', 'e', 'p', '-', 'r', 'a', 'd', '-', '0', '0', '0', '0',  // ... GUID.
      1, 1, 3, 1, 0xFF, 0, 9, 4, 1, 0, 0, 0x0E, 2, 0,
      0,  // Interface 1: video streaming.
      15, 0x24, 1, 2, 0, 0, 0x81, 0, 0, 0, 0, 0, 1, 0, 0, 27, 0x24, 4, 2,
      1,  // Format 2: 16 bit per pixel, ...
      'Y', '1', '6', ' ', 0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71, 16, 1, 0, 0, 0, 0,
      30, 0x24, 5, 1, 0, 160, 0, 120, 0,  // ... frame size 1: 160 x 120, ...
      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x07, 0xF4, 0x10, 0x00,  // ... 111.1 ms, ...
      1, 0x07, 0xF4, 0x10, 0x00, 11, 0x24, 6, 1, 0, 0, 0, 0, 0, 0,
      0,                             // ... and a compressed format, which is left out.
      9, 4, 1, 1, 1, 0x0E, 2, 0, 0,  // Alternate setting 1: ...
      7, 5, 0x81, 5, 0x82, 0x02, 1,  // ... 642 bytes.
      9, 4, 1, 2, 1, 0x0E, 2, 0, 0,  // Alternate setting 2: ...
      7, 5, 0x81, 5, 0x00, 0x14, 1,  // ... three times 1024 bytes.
  };
  data[2] = static_cast<std::uint8_t>(data.size());
  data[3] = static_cast<std::uint8_t>(data.size() >> 8);
  return data;
}

UvcFunction Parse(const Data& data) {
  const Result<UsbConfiguration> configuration = ParseConfiguration(data);
  EXPECT_TRUE(configuration.has_value());
  const Result<UvcFunction> function = ParseUvc(*configuration);
  EXPECT_TRUE(function.has_value());
  return *function;
}

TEST(UvcDescriptorsTest, FindsUnitsByGuidWhateverTheirId) {
  const UvcFunction function = Parse(Camera());
  EXPECT_EQ(function.version, 0x0100);
  EXPECT_EQ(function.clock_hz, 6'000'000U);
  constexpr UvcGuid kRad = {'p', 't', '1', '-', 'l', 'e', 'p', '-',
                            'r', 'a', 'd', '-', '0', '0', '0', '0'};
  EXPECT_EQ(function.UnitWithGuid(kRad), 5);
  EXPECT_EQ(function.UnitWithGuid(UvcGuid{}), std::nullopt);
}

TEST(UvcDescriptorsTest, ReadsFormatsAndFrameSizes) {
  const UvcFunction function = Parse(Camera());
  ASSERT_EQ(function.formats.size(), 1U);
  EXPECT_EQ(function.formats[0].index, 2);
  EXPECT_EQ(function.formats[0].four_characters(), "Y16 ");
  EXPECT_EQ(function.formats[0].bits_per_pixel, 16);
  ASSERT_EQ(function.formats[0].frames.size(), 1U);
  EXPECT_EQ(function.formats[0].frames[0].width, 160);
  EXPECT_EQ(function.formats[0].frames[0].height, 120);
  EXPECT_EQ(function.formats[0].frames[0].default_interval, 1'111'047U);
}

TEST(UvcDescriptorsTest, ReadsBandwidthWithHighSpeedMultiples) {
  const UvcFunction function = Parse(Camera());
  ASSERT_EQ(function.alternates.size(), 2U);
  EXPECT_EQ(function.alternates[0].number, 1);
  EXPECT_EQ(function.alternates[0].endpoint.packet_bytes, 642);
  EXPECT_EQ(function.alternates[0].endpoint.kind, UsbTransferKind::kIsochronous);
  EXPECT_EQ(function.alternates[1].endpoint.packet_bytes, 3 * 1024);
}

/// Parses `data` where memory ends behind it.
Result<UsbConfiguration> ParseGuarded(const Data& data) {
  const testing::GuardedBuffer buffer(data);
  return ParseConfiguration(buffer.bytes());
}

TEST(UsbDescriptorsTest, EveryTruncationIsRefused) {
  const Data data = Camera();
  for (std::size_t length = 0; length < data.size(); ++length) {
    const auto parsed =
        ParseGuarded(Data(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(length)));
    ASSERT_FALSE(parsed.has_value()) << length;
    EXPECT_EQ(parsed.error().code(), StatusCode::kDataLoss) << length;
  }
}

/// No more came out than went in, and nothing that was not there.
void ExpectFromInput(const UsbConfiguration& configuration, const Data& data) {
  std::size_t min_bytes = 9;
  for (const UsbInterface& interface : configuration.interfaces) {
    ASSERT_FALSE(interface.alternates.empty());
    for (const UsbAlternate& alternate : interface.alternates) {
      min_bytes += 9 + 7 * alternate.endpoints.size() + alternate.class_specific.size();
      for (const UsbEndpoint& endpoint : alternate.endpoints) {
        EXPECT_LE(endpoint.packet_bytes, 4 * 2047);
        EXPECT_GE(endpoint.packet_bytes, 0);
      }
      const Data& chain = alternate.class_specific;
      for (std::size_t at = 0; at < chain.size(); at += chain[at]) {
        ASSERT_GE(chain[at], 2);
        ASSERT_LE(at + chain[at], chain.size());
        const auto begin = chain.begin() + static_cast<std::ptrdiff_t>(at);
        EXPECT_NE(std::search(data.begin(), data.end(), begin, begin + chain[at]), data.end());
      }
    }
  }
  EXPECT_LE(min_bytes, data.size());
}

void ExpectFromInput(const UvcFunction& function, const Data& data) {
  std::size_t min_bytes = 20 * function.units.size();
  for (const UvcFormat& format : function.formats) min_bytes += 22 + 26 * format.frames.size();
  EXPECT_LE(min_bytes, data.size());
  EXPECT_LE(7 * function.alternates.size(), data.size());
}

/// Holds what came of some inputs.
struct Outcomes {
  int valid = 0;
  int no_video = 0;
  int refused = 0;

  /// Parses; whatever comes of it must be one of these.
  void Add(const Data& data) {
    const Result<UsbConfiguration> configuration = ParseGuarded(data);
    if (!configuration) {
      EXPECT_EQ(configuration.error().code(), StatusCode::kDataLoss);
      ++refused;
      return;
    }
    ExpectFromInput(*configuration, data);
    const Result<UvcFunction> function = ParseUvc(*configuration);
    if (function) {
      ExpectFromInput(*function, data);
      ++valid;
    } else if (function.error().code() == StatusCode::kNotFound) {
      ++no_video;
    } else {
      EXPECT_EQ(function.error().code(), StatusCode::kDataLoss);
      ++refused;
    }
  }
};

/// Where one descriptor of `data` ends and the next begins, counted by their first bytes.
std::set<std::size_t> Boundaries(const Data& data) {
  std::set<std::size_t> boundaries;
  for (std::size_t at = 0; at < data.size(); at += data[at]) boundaries.insert(at + data[at]);
  return boundaries;
}

TEST(UsbDescriptorsTest, AShorterTotalIsTakenWhereADescriptorEndsAndRefusedElsewhere) {
  const std::set<std::size_t> boundaries = Boundaries(Camera());
  ASSERT_EQ(boundaries.size(), 13U);
  for (std::size_t length = 9; length < Camera().size(); ++length) {
    Data cut = Camera();
    cut.resize(length);
    PutLe16(cut, 2, static_cast<std::uint16_t>(length));
    const Result<UsbConfiguration> parsed = ParseGuarded(cut);
    EXPECT_EQ(parsed.has_value(), boundaries.contains(length)) << length;
    if (parsed) ExpectFromInput(*parsed, cut);
  }
}

TEST(UsbDescriptorsTest, AHostileByteIsRefusedOrReadAsWhatIsThere) {
  const Data data = Camera();
  Outcomes outcomes;
  for (std::size_t i = 0; i < data.size(); ++i) {
    for (const int value : {0x00, 0x01, 0x02, 0x03, 0x7F, 0xFF}) {
      SCOPED_TRACE(::testing::Message() << "byte " << i << " = " << value);
      Data hostile = data;
      hostile[i] = static_cast<std::uint8_t>(value);
      outcomes.Add(hostile);
    }
  }
  // A descriptor's length, type or subtype decides; most other bytes may have any value.
  EXPECT_GT(outcomes.refused, 50);
  EXPECT_GT(outcomes.no_video, 5);
  EXPECT_GT(outcomes.valid, 500);
}

TEST(UsbDescriptorsTest, AnyLengthOfADescriptorStaysInsideTheBuffer) {
  const Data data = Camera();
  Outcomes outcomes;
  for (std::size_t at = 0; at < data.size(); at += data[at]) {
    for (int length = 0; length < 256; ++length) {
      SCOPED_TRACE(::testing::Message() << "descriptor at " << at << ", length " << length);
      Data hostile = data;
      hostile[at] = static_cast<std::uint8_t>(length);
      outcomes.Add(hostile);
    }
  }
  EXPECT_GT(outcomes.refused, 1000);
  EXPECT_GE(outcomes.valid, 13) << "the right lengths are among them";
}

TEST(UvcDescriptorsTest, DeviceWithoutVideoIsNotFound) {
  Data data = Camera();
  std::replace(data.begin(), data.end(), 0x0E, 0x08);
  const auto configuration = ParseConfiguration(data);
  ASSERT_TRUE(configuration.has_value());
  EXPECT_EQ(ParseUvc(*configuration).error().code(), StatusCode::kNotFound);
}

TEST(UvcProbeTest, HasTheLengthOfItsVersion) {
  EXPECT_EQ(UvcProbeBytes(0x0100), 26U);
  EXPECT_EQ(UvcProbeBytes(0x0110), 34U);
  EXPECT_EQ(UvcProbeBytes(0x0150), 48U);
}

TEST(UvcProbeTest, PutsFieldsWhereTheTableSays) {
  const Data bytes = PackUvcProbe({2, 3, 400'000, 39'040, 642, 6'000'000}, 34);
  EXPECT_EQ(bytes[2], 2);
  EXPECT_EQ(bytes[3], 3);
  EXPECT_EQ(Le32(bytes, 4), 400'000U);
  EXPECT_EQ(Le32(bytes, 18), 39'040U);
  EXPECT_EQ(Le32(bytes, 22), 642U);
  EXPECT_EQ(Le32(bytes, 26), 6'000'000U);
}

TEST(UvcProbeTest, EveryTruncationIsRefused) {
  const Data bytes = PackUvcProbe({2, 3, 400'000, 39'040, 642, 6'000'000}, 26);
  EXPECT_EQ(UnpackUvcProbe(bytes)->max_payload_bytes, 642U);
  for (std::size_t length = 0; length < 26; ++length) {
    EXPECT_FALSE(UnpackUvcProbe(Bytes(bytes).first(length)).has_value()) << length;
  }
}

}  // namespace
}  // namespace isotherm
