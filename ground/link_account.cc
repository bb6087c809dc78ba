#include "ground/link_account.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {
namespace {

constexpr double kMsPerS = 1e3;

Json DescribeStream(const StreamAccount& account, std::uint64_t recorded) {
  Json json;
  json["published"] = account.published;
  json["received"] = account.received;
  json["missing"] = account.missing;
  json["late"] = account.late;
  json["duplicates"] = account.duplicates;
  json["refused"] = account.refused;
  json["recorded"] = recorded;
  return json;
}

std::string StreamText(const char* name, const StreamAccount& account, std::uint64_t recorded) {
  return fmt::format("{:<8} {} published = {} received + {} missing; {} recorded\n", name,
                     account.published, account.received, account.missing, recorded);
}

}  // namespace

void DescribeAccount(const SessionAccount& account, const RecordingStats& recorded, Json& link) {
  link["depth"] = DescribeStream(account.depth, recorded.depth_frames);
  link["thermal"] = DescribeStream(account.thermal, recorded.thermal_frames);
  link["recording_failed_frames"] = recorded.failed;
  Json& feedback = link["feedback"];
  feedback["received_by_edge"] = account.feedback.count;
  if (!std::isfinite(account.feedback.p50_s)) return;
  feedback["latency_p50_ms"] = kMsPerS * account.feedback.p50_s;
  feedback["latency_p99_ms"] = kMsPerS * account.feedback.p99_s;
}

std::string AccountText(const SessionAccount& account, const RecordingStats& recorded) {
  std::string text = StreamText("link", account.depth, recorded.depth_frames) +
                     StreamText("", account.thermal, recorded.thermal_frames);
  if (!std::isfinite(account.feedback.p50_s)) return text;
  return text + fmt::format(
                    "feedback {} messages, from depth capture to arrival on the edge p50 "
                    "{:.0f} ms, p99 {:.0f} ms\n",
                    account.feedback.count, kMsPerS * account.feedback.p50_s,
                    kMsPerS * account.feedback.p99_s);
}

}  // namespace isotherm
