#include "ground/console/console_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

std::string MessageFor(const std::function<void(ConsoleOptions&)>& change) {
  ConsoleOptions options;
  change(options);
  return Validate(options).message();
}

TEST(ConsoleOptionsTest, DefaultsAreTaken) { EXPECT_TRUE(Validate(ConsoleOptions()).ok()); }

TEST(ConsoleOptionsTest, APortIsOneOfTcpOrAnyThatIsFree) {
  EXPECT_EQ(MessageFor([](auto& o) { o.set_port(0); }), "");
  EXPECT_EQ(MessageFor([](auto& o) { o.set_port(65'535); }), "");
  EXPECT_THAT(MessageFor([](auto& o) { o.set_port(65'536); }), HasSubstr("console.port"));
  EXPECT_THAT(MessageFor([](auto& o) { o.set_port(-1); }), HasSubstr("console.port"));
}

TEST(ConsoleOptionsTest, ACertificateNeedsItsKey) {
  EXPECT_THAT(MessageFor([](auto& o) { o.set_certificate_file("a.pem"); }),
              HasSubstr("go together"));
  EXPECT_THAT(MessageFor([](auto& o) { o.set_key_file("a.key"); }), HasSubstr("go together"));
}

TEST(ConsoleOptionsTest, WhatCannotBeIsRefusedByName) {
  EXPECT_THAT(MessageFor([](auto& o) { o.set_address(""); }), HasSubstr("console.address"));
  EXPECT_THAT(MessageFor([](auto& o) { o.mutable_expert()->set_max_viewers(0); }),
              HasSubstr("max_viewers"));
  EXPECT_THAT(MessageFor([](auto& o) { o.mutable_expert()->set_copy_ms(31.0); }),
              HasSubstr("copy_ms"));
  EXPECT_THAT(MessageFor([](auto& o) { o.mutable_expert()->set_mesh_cores(NAN); }),
              HasSubstr("mesh_cores"));
  EXPECT_THAT(MessageFor([](auto& o) { o.mutable_expert()->set_refresh_s(-0.1); }),
              HasSubstr("refresh_s"));
  EXPECT_THAT(MessageFor([](auto& o) { o.mutable_expert()->set_image_hz(0.0); }),
              HasSubstr("image_hz"));
  EXPECT_THAT(MessageFor([](auto& o) { o.mutable_expert()->set_viewer_mbit_s(0.0); }),
              HasSubstr("viewer_mbit_s"));
}

}  // namespace
}  // namespace isotherm
