#include "common/pieces/erasure_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

namespace isotherm {
namespace {

/// A multiplication in GF(2^8) modulo x^8 + x^4 + x^3 + x^2 + 1, bit by bit.
std::uint8_t Times(std::uint8_t a, std::uint8_t b) {
  unsigned product = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    if ((b >> bit & 1U) != 0) product ^= static_cast<unsigned>(a) << bit;
  }
  for (unsigned bit = 15; bit >= 8; --bit) {
    if ((product >> bit & 1U) != 0) product ^= 0x11DU << (bit - 8);
  }
  return static_cast<std::uint8_t>(product);
}

std::uint8_t Inverse(std::uint8_t a) {
  for (unsigned b = 1; b < 256; ++b) {
    if (Times(a, static_cast<std::uint8_t>(b)) == 1) return static_cast<std::uint8_t>(b);
  }
  return 0;
}

std::vector<Bytes> RandomPieces(int number, std::size_t size, std::mt19937* random) {
  std::vector<Bytes> pieces(static_cast<std::size_t>(number), Bytes(size));
  for (Bytes& piece : pieces) {
    std::ranges::generate(piece, [&] { return static_cast<std::uint8_t>((*random)()); });
  }
  return pieces;
}

TEST(ErasureCodeTest, ParityIsTheCauchyMatrixTimesTheData) {
  std::mt19937 random(1);
  const std::vector<Bytes> data = RandomPieces(5, 40, &random);
  const std::vector<Bytes> parity = ParityOf(data, 3);
  ASSERT_EQ(parity.size(), 3U);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 40; ++i) {
      std::uint8_t sum = 0;
      for (std::size_t k = 0; k < 5; ++k) {
        sum ^= Times(Inverse(static_cast<std::uint8_t>((5 + row) ^ k)), data[k][i]);
      }
      EXPECT_EQ(parity[row][i], sum);
    }
  }
}

TEST(ErasureCodeTest, AnyKAreEnough) {
  std::mt19937 random(2);
  for (const auto& [k, rows] : {std::array{1, 3}, {4, 4}, {65, 12}, {128, 127}}) {
    const std::vector<Bytes> data = RandomPieces(k, 300, &random);
    const std::vector<Bytes> parity = ParityOf(data, rows);
    std::vector<CodedPiece> all;
    for (int row = 0; row < k + rows; ++row) {
      const auto index = static_cast<std::size_t>(row);
      all.push_back({row, row < k ? data[index] : parity[index - data.size()]});
    }
    for (int attempt = 0; attempt < 20; ++attempt) {
      std::ranges::shuffle(all, random);
      const auto some = std::span(all).first(static_cast<std::size_t>(k));
      EXPECT_EQ(RecoverData(some), data) << k << " + " << rows;
    }
  }
}

TEST(ErasureCodeTest, WhatCannotBeIsNotRecovered) {
  const Bytes piece(16, 1);
  EXPECT_TRUE(RecoverData({}).empty());
  EXPECT_TRUE(RecoverData(std::array{CodedPiece{0, piece}, CodedPiece{0, piece}}).empty());
  EXPECT_TRUE(RecoverData(std::array{CodedPiece{255, piece}}).empty());
  EXPECT_TRUE(RecoverData(std::array{CodedPiece{-1, piece}}).empty());
  const Bytes longer(17, 1);
  EXPECT_TRUE(RecoverData(std::array{CodedPiece{0, piece}, CodedPiece{1, longer}}).empty());
}

}  // namespace
}  // namespace isotherm
