#include "common/security/sha256.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

// FIPS 180-4, examples of the National Institute of Standards and Technology.
constexpr const char* kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* kOfNothing =
    "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr const char* kOfAMillionA =
    "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256Test, KnownTextsHaveTheirDigests) {
  EXPECT_EQ(Sha256Of("abc"), kOfAbc);
  EXPECT_EQ(Sha256Of(""), kOfNothing);
}

TEST(Sha256Test, AFileHasTheDigestOfItsBytes) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "a";
  // Not a multiple of a piece.
  std::ofstream(path, std::ios::binary) << std::string(1'000'000, 'a');
  EXPECT_EQ(Sha256OfFile(path).value(), kOfAMillionA);
  EXPECT_EQ(Sha256OfFile(folder.path() / "b").error().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace isotherm
