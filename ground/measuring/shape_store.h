#pragma once

#include <deque>
#include <filesystem>

#include "common/base/status.h"
#include "ground/measuring/measuring.pb.h"

namespace isotherm {

/// The name of the file in a scan's folder.
inline constexpr const char* kShapesName = "shapes.json";

/// Reads shapes; kNotFound if there is no such file. Messages name the file.
Result<measuring::ShapeList> ReadShapes(const std::filesystem::path& path);
/// Writes them; the file appears only when it is complete.
Status WriteShapes(const std::filesystem::path& path, const measuring::ShapeList& shapes);

/// A message as JSON with the names of its fields; numbers read back exactly.
std::string ExactJson(const google::protobuf::Message& message);

/// The list of what is measured, and its changes, which can be taken back. Thread-compatible.
class ShapeStore {
 public:
  /// Begins anew with these.
  void Reset(measuring::ShapeList shapes);
  /// Adds a shape, or changes the one with the same id. Refuses what Validate does, and too many.
  Status Put(const measuring::Shape& shape);
  /// kNotFound if there is none.
  Status Remove(const std::string& id);
  Status Clear();
  /// Takes the last change back; kFailedPrecondition if there is none.
  Status Undo();

  const measuring::ShapeList& shapes() const { return shapes_; }
  std::size_t undoable() const { return before_.size(); }

 private:
  void Remember();
  measuring::ShapeList shapes_;
  std::deque<measuring::ShapeList> before_;
};

}  // namespace isotherm
