#include "ground/measuring/shape_store.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <utility>

#include "common/base/output_file.h"
#include "common/base/read_file.h"
#include "ground/measuring/shape_measurer.h"

namespace isotherm {
namespace {

constexpr int kMaxShapes = 500;
constexpr std::size_t kMaxUndo = 100;
constexpr std::size_t kMaxFileBytes = 16U << 20;

}  // namespace

void ShapeStore::Reset(measuring::ShapeList shapes) {
  shapes_ = std::move(shapes);
  before_.clear();
}

void ShapeStore::Remember() {
  before_.push_back(shapes_);
  if (before_.size() > kMaxUndo) before_.pop_front();
}

Status ShapeStore::Put(const measuring::Shape& shape) {
  ISOTHERM_RETURN_IF_ERROR(Validate(shape));
  const auto found = std::ranges::find(*shapes_.mutable_shapes(), shape.id(),
                                       [](const measuring::Shape& s) { return s.id(); });
  if (found == shapes_.shapes().end() && shapes_.shapes_size() >= kMaxShapes)
    return ResourceExhausted(fmt::format("no more than {} shapes", kMaxShapes));
  Remember();
  if (found == shapes_.shapes().end()) {
    *shapes_.add_shapes() = shape;
  } else {
    *found = shape;
  }
  return OkStatus();
}

Status ShapeStore::Remove(const std::string& id) {
  const auto& shapes = shapes_.shapes();
  const auto found =
      std::ranges::find(shapes, id, [](const measuring::Shape& s) { return s.id(); });
  if (found == shapes.end()) return NotFound("there is no shape of that id");
  Remember();
  shapes_.mutable_shapes()->erase(found);
  return OkStatus();
}

Status ShapeStore::Clear() {
  if (shapes_.shapes().empty()) return OkStatus();
  Remember();
  shapes_.Clear();
  return OkStatus();
}

Status ShapeStore::Undo() {
  if (before_.empty()) return FailedPrecondition("there is nothing to take back");
  shapes_ = std::move(before_.back());
  before_.pop_back();
  return OkStatus();
}

Result<measuring::ShapeList> ReadShapes(const std::filesystem::path& path) {
  const auto text = ReadFile(path, kMaxFileBytes);
  if (!text) return Err(text.error());
  measuring::ShapeList shapes;
  if (const auto parsed = google::protobuf::util::JsonStringToMessage(*text, &shapes);
      !parsed.ok()) {
    return Err(
        InvalidArgument(fmt::format("{}: {}", path.string(), std::string(parsed.message()))));
  }
  for (const measuring::Shape& shape : shapes.shapes()) {
    if (const Status valid = Validate(shape); !valid.ok()) {
      return Err(InvalidArgument(
          fmt::format("{}: shape \"{}\": {}", path.string(), shape.id(), valid.message())));
    }
  }
  return shapes;
}

Status WriteShapes(const std::filesystem::path& path, const measuring::ShapeList& shapes) {
  return WriteFile(path, ExactJson(shapes));
}

std::string ExactJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  std::string text;
  static_cast<void>(google::protobuf::util::MessageToJsonString(message, &text, options));
  return text;
}

}  // namespace isotherm
