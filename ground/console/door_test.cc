#include "ground/console/door.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/security/certificate.h"
#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::TemporaryDirectory;

class DoorTest : public ::testing::Test {
 protected:
  DoorTest() { options_.mutable_console()->set_state_dir((folder_.path() / "state").string()); }
  static unsigned Mode(const std::filesystem::path& path) {
    struct stat info {};
    EXPECT_EQ(stat(path.c_str(), &info), 0);
    return info.st_mode & 0777U;
  }
  const TemporaryDirectory folder_;
  GroundOptions options_;
};

TEST_F(DoorTest, OnThisComputerItIsPlainAndOpen) {
  const auto door = PrepareDoor(options_);
  ASSERT_TRUE(door);
  EXPECT_FALSE(door->is_secure);
  EXPECT_FALSE(door->tokens);
  EXPECT_EQ(door->Address(8080), "http://127.0.0.1:8080");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "state"));
}

TEST_F(DoorTest, OnOtherAddressesItIsEncryptedAndHasCodes) {
  options_.mutable_console()->set_address("0.0.0.0");
  const auto door = PrepareDoor(options_);
  ASSERT_TRUE(door) << door.error().message();
  EXPECT_TRUE(door->is_secure);
  ASSERT_TRUE(door->tokens);
  EXPECT_NE(door->tokens->viewer, door->tokens->operator_token);
  EXPECT_THAT(door->Address(8080, door->tokens->viewer), StartsWith("https://"));
  EXPECT_EQ(door->fingerprint.size(), 32U * 3 - 1);
}

TEST_F(DoorTest, SecretsAreTheOwnersAlone) {
  options_.mutable_console()->set_address("0.0.0.0");
  ASSERT_TRUE(PrepareDoor(options_));
  EXPECT_EQ(Mode(folder_.path() / "state" / "codes.txt"), 0600U);
  EXPECT_EQ(Mode(folder_.path() / "state" / "key.pem"), 0600U);
}

TEST_F(DoorTest, CodesAndCertificateStayTheSame) {
  options_.mutable_console()->set_address("0.0.0.0");
  const auto first = PrepareDoor(options_);
  const auto second = PrepareDoor(options_);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->tokens->operator_token, second->tokens->operator_token);
  EXPECT_EQ(first->fingerprint, second->fingerprint);
}

TEST_F(DoorTest, ACertificateThatIsNoneIsRefusedByName) {
  options_.mutable_console()->set_tls(true);
  options_.mutable_console()->set_certificate_file("/nowhere/certificate.pem");
  const auto door = PrepareDoor(options_);
  ASSERT_FALSE(door);
  EXPECT_THAT(door.error().message(), HasSubstr("/nowhere/certificate.pem"));
}

TEST_F(DoorTest, ABrokenCertificateIsMadeAnew) {
  const auto files = PrepareCertificate(folder_.path(), {"localhost", "127.0.0.1"});
  ASSERT_TRUE(files);
  const auto before = CertificateFingerprint(files->certificate);
  std::filesystem::resize_file(files->certificate, 40);
  ASSERT_TRUE(PrepareCertificate(folder_.path(), {"localhost"}));
  const auto after = CertificateFingerprint(files->certificate);
  ASSERT_TRUE(before && after);
  EXPECT_NE(*before, *after);
}

TEST(QrTextTest, TheCodeHasItsThreeCorners) {
  const std::string text = QrText("https://192.168.1.7:8080/#code=abc");
  // A finder's upper edge: dark over light in the first row of characters, after the quiet zone.
  EXPECT_THAT(text, HasSubstr("█ ▄▄▄▄▄ █"));
  EXPECT_EQ(QrText(std::string(10000, 'x')), "");
}

}  // namespace
}  // namespace isotherm
