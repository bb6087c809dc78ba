#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

namespace isotherm::testing {

/// Random tests print their seed; ISOTHERM_TEST_SEED repeats one.
inline std::uint32_t Seed() {
  const char* const text = std::getenv("ISOTHERM_TEST_SEED");
  const std::uint32_t seed = text != nullptr
                                 ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10))
                                 : std::random_device{}();
  std::printf("seed %u\n", seed);
  return seed;
}

}  // namespace isotherm::testing
