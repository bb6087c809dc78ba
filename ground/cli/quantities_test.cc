#include "ground/cli/quantities.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(QuantitiesTest, LengthsNeedAUnit) {
  EXPECT_DOUBLE_EQ(ParseLength("10mm", "--x").value(), 0.010);
  EXPECT_DOUBLE_EQ(ParseLength("25um", "--x").value(), 25e-6);
  EXPECT_DOUBLE_EQ(ParseLength("25µm", "--x").value(), 25e-6);
  EXPECT_DOUBLE_EQ(ParseLength("2.5 cm", "--x").value(), 0.025);
  EXPECT_DOUBLE_EQ(ParseLength("0.5m ", "--x").value(), 0.5);
  for (const char* wrong : {"", "10", "mm", "ten mm", "-1mm", "0m", "1e999m", "10mm x", "1,5mm"}) {
    const auto length = ParseLength(wrong, "--focus");
    ASSERT_FALSE(length) << wrong;
    EXPECT_EQ(length.error().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(length.error().message().find("--focus"), std::string::npos);
  }
}

TEST(QuantitiesTest, TolerancesAreFractionsOrKelvin) {
  const auto fraction = ParseTolerance("2%", "--t");
  EXPECT_DOUBLE_EQ(fraction->value, 0.02);
  EXPECT_FALSE(fraction->in_kelvin);
  const auto kelvin = ParseTolerance("1.5 K", "--t");
  EXPECT_DOUBLE_EQ(kelvin->value, 1.5);
  EXPECT_TRUE(kelvin->in_kelvin);
  for (const char* wrong : {"2", "-2%", "0K", "2C", "nan%"})
    EXPECT_FALSE(ParseTolerance(wrong, "--t")) << wrong;
}

}  // namespace
}  // namespace isotherm
