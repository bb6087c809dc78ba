#include "ground/console/place_query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

class PlaceQueryTest : public ::testing::Test {
 protected:
  void Ask(const std::string& body, const std::string& method = "POST") {
    WebRequest request;
    request.method = method;
    request.path = kQueryPath;
    request.body = body;
    AskForPlace(request, {inbox_, now_, is_growing_},
                [this](WebReply reply) { reply_ = std::move(reply); });
  }
  /// Expects that it was refused at once, and that nobody else hears of it.
  void ExpectRefused(int status, const std::string& why) {
    ASSERT_TRUE(reply_);
    EXPECT_EQ(reply_->status, status);
    EXPECT_THAT(*reply_->body, HasSubstr(why));
    EXPECT_TRUE(inbox_.TakeEvents().empty());
  }

  ConsoleInbox inbox_;
  SteadyTime now_{std::chrono::hours(1)};
  bool is_growing_ = false;
  std::optional<WebReply> reply_;
};

TEST_F(PlaceQueryTest, TheConsoleAnswersWithARecord) {
  Ask(R"({"ray": {"origin": {"x": 0.5, "y": -1}, "direction": {"z": 2}},
          "parameters": {"emissivity": 0.9}})");
  EXPECT_FALSE(reply_);
  std::vector<ConsoleEvent> events = inbox_.TakeEvents();
  ASSERT_EQ(events.size(), 1U);
  const auto& query = std::get<ClientQuery>(events[0]);
  EXPECT_EQ(query.message.pick().ray().origin().x(), 0.5);
  EXPECT_EQ(query.message.pick().ray().origin().y(), -1.0);
  EXPECT_EQ(query.message.pick().ray().direction().z(), 2.0);
  EXPECT_EQ(query.message.pick().parameters().emissivity(), 0.9);

  live::Answer answer;
  answer.mutable_record()->set_hit(true);
  answer.mutable_record()->set_apparent_celsius(81.25);
  query.reply(answer);
  ASSERT_TRUE(reply_);
  EXPECT_EQ(reply_->status, 200);
  EXPECT_EQ(reply_->content_type, "application/json");
  const auto record = nlohmann::json::parse(*reply_->body);
  EXPECT_EQ(record["hit"], true);
  EXPECT_EQ(record["apparent_celsius"], 81.25);
  EXPECT_FALSE(record.contains("sigma_k")) << "it was never measured";
}

TEST_F(PlaceQueryTest, AScanThatGoesOnIsCopiedForWhoAsks) {
  constexpr const char* kQuestion = R"({"ray": {"origin": {}, "direction": {"z": 1}}})";
  is_growing_ = true;
  Ask(kQuestion);
  ExpectRefused(503, "ask again");
  reply_.reset();
  now_ += std::chrono::seconds(9);
  EXPECT_TRUE(inbox_.IsWatched(now_));
  Ask(kQuestion);
  EXPECT_FALSE(reply_) << "the console is asked";
  EXPECT_EQ(inbox_.TakeEvents().size(), 1U);
  now_ += std::chrono::seconds(11);
  EXPECT_FALSE(inbox_.IsWatched(now_)) << "nothing is copied for nobody";
  Ask(kQuestion);
  ExpectRefused(503, "ask again");
  reply_.reset();
  inbox_.viewers = 1;
  now_ += std::chrono::seconds(60);
  Ask(kQuestion);
  EXPECT_FALSE(reply_);
}

TEST_F(PlaceQueryTest, WhatIsNoQuestionIsRefusedInWords) {
  Ask("{", "POST");
  ExpectRefused(400, "not a question");
  Ask(R"({"rays": {}})");
  ExpectRefused(400, "rays");
  Ask(R"({"ray": {"origin": {"x": "near"}, "direction": {"z": 1}}})");
  ExpectRefused(400, "near");
  Ask("{}");
  ExpectRefused(400, "ray.origin");
  Ask(R"({"ray": {"origin": {}}})");
  ExpectRefused(400, "ray.direction is missing");
  Ask("", "GET");
  ExpectRefused(405, "POST");
}

}  // namespace
}  // namespace isotherm
