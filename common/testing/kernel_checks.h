#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace isotherm::testing {

/// Calls `check` once for each instruction set that the kernels were compiled for and this
/// processor has: each has another number of lanes or another rounding.
template <typename Check>
void ForEachInstructionSet(const Check& check) {
  std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  if (std::find(targets.begin(), targets.end(), HWY_STATIC_TARGET) == targets.end())
    targets.push_back(HWY_STATIC_TARGET);
  for (const std::int64_t target : targets) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// Most lanes of any instruction set: widths up to several times this meet every tail.
inline constexpr int kMaxLanes = 16;

/// A kernel must leave it alone behind its output.
inline constexpr std::int32_t kCanary = -123456789;

/// Random numbers, the same in every run unless ISOTHERM_TEST_SEED says otherwise.
class Random {
 public:
  Random() {
    const char* const text = std::getenv("ISOTHERM_TEST_SEED");
    const auto seed = text == nullptr ? std::mt19937::default_seed : std::stoul(text);
    std::printf("seed %lu\n", static_cast<unsigned long>(seed));
    engine_.seed(static_cast<std::mt19937::result_type>(seed));
  }
  float Uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(engine_);
  }
  /// low .. high, both included.
  int Integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool Chance(double probability) { return std::bernoulli_distribution(probability)(engine_); }

 private:
  std::mt19937 engine_;
};

/// Rounding of a sum of a few products in single precision, as a fraction of their magnitudes.
inline constexpr double kSinglePrecision = 1e-6;

/// A decision falls one way, the other, or is so near its threshold that rounding decides.
enum class Tribool { kNo, kYes, kEither };

/// Tells whether value >= 0; `slack` is its rounding in single precision. NaN is no.
inline Tribool AtLeastZero(double value, double slack) {
  if (!(value >= -slack)) return Tribool::kNo;
  return value > slack || slack == 0.0 ? Tribool::kYes : Tribool::kEither;
}

/// Returns whether both are so.
inline Tribool Both(Tribool a, Tribool b) {
  if (a == Tribool::kNo || b == Tribool::kNo) return Tribool::kNo;
  return a == Tribool::kYes && b == Tribool::kYes ? Tribool::kYes : Tribool::kEither;
}

}  // namespace isotherm::testing
