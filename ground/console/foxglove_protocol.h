#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// The names under which the protocol is spoken: the messages are the same.
inline constexpr std::string_view kFoxgloveSubprotocols[] = {"foxglove.sdk.v1",
                                                             "foxglove.websocket.v1"};

// The Foxglove WebSocket protocol: JSON about channels and services, binary for data.

struct FoxgloveChannel {
  std::uint32_t id = 0;
  std::string topic, encoding, schema_name;
  std::string schema;  ///< A FileDescriptorSet, or a JSON schema.
  std::string schema_encoding;
};
struct FoxgloveService {
  std::uint32_t id = 0;
  std::string name;
  std::string request_schema;  ///< JSON schemas.
};

/// Holds what a client says.
struct FoxgloveRequest {
  enum class Kind { kSubscribe, kUnsubscribe, kCall, kOther };
  struct Subscription {
    std::uint32_t id = 0;
    std::uint32_t channel = 0;
  };
  Kind kind = Kind::kOther;
  std::vector<Subscription> subscriptions;  ///< For kSubscribe; for kUnsubscribe the ids count.
  std::uint32_t service = 0, call = 0;      ///< For kCall.
  std::string encoding, payload;            ///< For kCall.
};

std::string ServerInfoText(const std::string& name, const std::string& session_id);
std::string AdvertiseText(const std::vector<FoxgloveChannel>& channels);
std::string AdvertiseServicesText(const std::vector<FoxgloveService>& services);
std::string CallFailureText(std::uint32_t service, std::uint32_t call, const std::string& why);
/// Data of a subscription, binary.
std::string DataMessage(std::uint32_t subscription, std::uint64_t time_ns,
                        std::string_view payload);
/// The answer to a call, binary, JSON in it.
std::string CallResponse(std::uint32_t service, std::uint32_t call, std::string_view json);

/// kInvalidArgument for what is none.
Result<FoxgloveRequest> ParseFoxgloveText(std::string_view text);
Result<FoxgloveRequest> ParseFoxgloveBinary(std::string_view bytes);

}  // namespace isotherm
