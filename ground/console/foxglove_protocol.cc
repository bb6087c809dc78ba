#include "ground/console/foxglove_protocol.h"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/base64.h"
#include "ground/json/json.h"

namespace isotherm {
namespace {

constexpr char kServiceCall = 2;  // From the client.
constexpr char kMessageData = 1;  // From the server, as the next.
constexpr char kServiceResponse = 3;
static_assert(std::endian::native == std::endian::little);

template <typename T>
void Append(T value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Takes a number from the front; nullopt if there are too few bytes.
std::optional<std::uint32_t> TakeNumber(std::string_view& bytes) {
  std::uint32_t value = 0;
  if (bytes.size() < sizeof(value)) return std::nullopt;
  std::memcpy(&value, bytes.data(), sizeof(value));
  bytes.remove_prefix(sizeof(value));
  return value;
}

std::optional<std::uint32_t> NumberOf(const Json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  const auto value = found->get<std::uint64_t>();
  if (value > 0xFFFFFFFFULL) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

}  // namespace

std::string ServerInfoText(const std::string& name, const std::string& session_id) {
  Json json;
  json["op"] = "serverInfo";
  json["name"] = name;
  json["capabilities"] = {"services"};
  json["supportedEncodings"] = {"json"};
  json["metadata"] = Json::object();
  json["sessionId"] = session_id;
  return json.dump();
}

std::string AdvertiseText(const std::vector<FoxgloveChannel>& channels) {
  Json json;
  json["op"] = "advertise";
  for (const FoxgloveChannel& channel : channels) {
    Json entry;
    entry["id"] = channel.id;
    entry["topic"] = channel.topic;
    entry["encoding"] = channel.encoding;
    entry["schemaName"] = channel.schema_name;
    entry["schemaEncoding"] = channel.schema_encoding;
    entry["schema"] =
        channel.schema_encoding == "protobuf" ? EncodeBase64(channel.schema) : channel.schema;
    json["channels"].push_back(std::move(entry));
  }
  return json.dump();
}

std::string AdvertiseServicesText(const std::vector<FoxgloveService>& services) {
  Json json;
  json["op"] = "advertiseServices";
  const auto schema = [](const std::string& name, const std::string& text) {
    Json entry;
    entry["encoding"] = "json";
    entry["schemaName"] = name;
    entry["schemaEncoding"] = "jsonschema";
    entry["schema"] = text;
    return entry;
  };
  constexpr const char* kAnswer =
      R"({"type":"object","properties":{"done":{"type":"boolean"},"text":{"type":"string"}}})";
  for (const FoxgloveService& service : services) {
    Json entry;
    entry["id"] = service.id;
    entry["name"] = service.name;
    entry["type"] = service.name;
    entry["request"] = schema(service.name + "Request", service.request_schema);
    entry["response"] = schema("Answer", kAnswer);
    // For clients from before there were encodings.
    entry["requestSchema"] = service.request_schema;
    entry["responseSchema"] = kAnswer;
    json["services"].push_back(std::move(entry));
  }
  return json.dump();
}

std::string CallFailureText(std::uint32_t service, std::uint32_t call, const std::string& why) {
  Json json;
  json["op"] = "serviceCallFailure";
  json["serviceId"] = service;
  json["callId"] = call;
  json["message"] = why;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string DataMessage(std::uint32_t subscription, std::uint64_t time_ns,
                        std::string_view payload) {
  std::string bytes(1, kMessageData);
  bytes.reserve(payload.size() + 13);
  Append(subscription, bytes);
  Append(time_ns, bytes);
  bytes += payload;
  return bytes;
}

std::string CallResponse(std::uint32_t service, std::uint32_t call, std::string_view json) {
  constexpr std::string_view kJson = "json";
  std::string bytes(1, kServiceResponse);
  Append(service, bytes);
  Append(call, bytes);
  Append(static_cast<std::uint32_t>(kJson.size()), bytes);
  bytes += kJson;
  bytes += json;
  return bytes;
}

Result<FoxgloveRequest> ParseFoxgloveText(std::string_view text) {
  constexpr std::size_t kMaxSubscriptions = 1000;
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("op") || !json["op"].is_string())
    return Err(InvalidArgument("not a message of the Foxglove protocol"));
  FoxgloveRequest request;
  const std::string op = json["op"];
  if (op == "subscribe") {
    request.kind = FoxgloveRequest::Kind::kSubscribe;
    if (!json.contains("subscriptions") || !json["subscriptions"].is_array())
      return Err(InvalidArgument("subscribe without subscriptions"));
    for (const Json& entry : json["subscriptions"]) {
      const auto id = NumberOf(entry, "id"), channel = NumberOf(entry, "channelId");
      if (!id || !channel || request.subscriptions.size() >= kMaxSubscriptions)
        return Err(InvalidArgument("a subscription without id and channelId, or too many"));
      request.subscriptions.push_back({*id, *channel});
    }
  } else if (op == "unsubscribe") {
    request.kind = FoxgloveRequest::Kind::kUnsubscribe;
    if (!json.contains("subscriptionIds") || !json["subscriptionIds"].is_array())
      return Err(InvalidArgument("unsubscribe without subscriptionIds"));
    for (const Json& id : json["subscriptionIds"]) {
      if (!id.is_number_unsigned() || request.subscriptions.size() >= kMaxSubscriptions)
        return Err(InvalidArgument("a subscription id that is none, or too many"));
      request.subscriptions.push_back({id.get<std::uint32_t>(), 0});
    }
  }
  return request;
}

Result<FoxgloveRequest> ParseFoxgloveBinary(std::string_view bytes) {
  FoxgloveRequest request;
  if (bytes.empty() || bytes.front() != kServiceCall) return request;  // Nothing that we offer.
  bytes.remove_prefix(1);
  const auto service = TakeNumber(bytes), call = TakeNumber(bytes), length = TakeNumber(bytes);
  if (!service || !call || !length || *length > bytes.size())
    return Err(InvalidArgument("a service call that ends too early"));
  request.kind = FoxgloveRequest::Kind::kCall;
  request.service = *service;
  request.call = *call;
  request.encoding = bytes.substr(0, *length);
  request.payload = bytes.substr(*length);
  return request;
}

}  // namespace isotherm
