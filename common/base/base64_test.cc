#include "common/base/base64.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(Base64Test, TheExamplesOfRfc4648AreEncodedAsThere) {
  EXPECT_EQ(EncodeBase64(""), "");
  EXPECT_EQ(EncodeBase64("f"), "Zg==");
  EXPECT_EQ(EncodeBase64("fo"), "Zm8=");
  EXPECT_EQ(EncodeBase64("foo"), "Zm9v");
  EXPECT_EQ(EncodeBase64("foob"), "Zm9vYg==");
  EXPECT_EQ(EncodeBase64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(EncodeBase64("foobar"), "Zm9vYmFy");
}

TEST(Base64Test, BytesAboveAsciiAreTakenAsTheyAre) {
  EXPECT_EQ(EncodeBase64(std::string("\xFF\xFE\x00\xFB", 4)), "//4A+w==");
}

}  // namespace
}  // namespace isotherm
