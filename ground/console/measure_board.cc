#include "ground/console/measure_board.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "common/base/log.h"

namespace isotherm {
namespace {

/// While the model grows, shapes are measured anew at most this often. Smaller: a value that jumps
/// about cannot be read.
constexpr Nanoseconds kMeasureInterval = std::chrono::seconds(1);
/// Measuring takes at most this fraction of a core.
constexpr double kMeasureCores = 0.1;

}  // namespace

void MeasureBoard::Begin(const std::filesystem::path& folder, const MeasuringOptions& options) {
  folder_ = folder;
  options_ = options;
  measurer_.reset();
  is_model_new_ = are_shapes_new_ = true;
  next_ = {};
  measuring::ShapeList shapes;
  if (!folder.empty()) {
    Result<measuring::ShapeList> read = ReadShapes(folder / kShapesName);
    if (read) {
      shapes = std::move(*read);
    } else if (read.error().code() != StatusCode::kNotFound) {
      LOG(Console, Warning) << read.error().message();
    }
  }
  store_.Reset(std::move(shapes));
}

ShapeMeasurer* MeasureBoard::Measurer() {
  if (is_model_new_) measurer_.reset();
  if (measurer_) return measurer_.get();
  const int map = model_.active_map();
  if (map >= model_.size() || !model_.map(map).tsdf) return nullptr;
  const ReadableMap& shown = model_.map(map);
  measurer_ = std::make_unique<ShapeMeasurer>(*shown.tsdf, *shown.thermal, shown.place.T_world_map,
                                              options_);
  is_model_new_ = false;
  are_shapes_new_ = true;
  return measurer_.get();
}

void MeasureBoard::Save() const {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (const Status saved = WriteShapes(folder_ / kShapesName, store_.shapes()); !saved.ok()) {
    LOG(Console, Warning) << "shapes are not kept: " << saved.message();
  }
}

Status MeasureBoard::Apply(const live::Edit& edit) {
  Status status;
  switch (edit.change_case()) {
    case live::Edit::kPut:
      status = store_.Put(edit.put());
      break;
    case live::Edit::kRemove:
      status = store_.Remove(edit.remove());
      break;
    case live::Edit::kClear:
      status = store_.Clear();
      break;
    case live::Edit::kUndo:
      status = store_.Undo();
      break;
    default:
      status = InvalidArgument("this change is not known");
  }
  if (!status.ok()) return status;
  are_shapes_new_ = true;
  next_ = {};
  Save();
  return status;
}

measuring::VoxelRecord MeasureBoard::Answer(const live::Pick& pick) {
  ShapeMeasurer* const measurer = Measurer();
  if (measurer == nullptr) return {};
  return measurer->Pick(pick.ray(), pick.parameters());
}

measuring::Measurements MeasureBoard::Measure() {
  measuring::Measurements all;
  *all.mutable_shapes() = store_.shapes().shapes();
  all.set_undoable(static_cast<std::uint32_t>(store_.undoable()));
  ShapeMeasurer* const measurer = Measurer();
  are_shapes_new_ = false;
  if (measurer != nullptr) {
    for (measuring::MeasuredShape& measured : measurer->Measure(store_.shapes()))
      *all.add_measured() = std::move(measured);
    return all;
  }
  for (const measuring::Shape& shape : store_.shapes().shapes()) {
    measuring::MeasuredShape& measured = *all.add_measured();
    measured.set_id(shape.id());
    measured.set_problem("there is no surface yet");
  }
  return all;
}

std::optional<measuring::Measurements> MeasureBoard::Update() {
  if (!are_shapes_new_ && (!is_model_new_ || store_.shapes().shapes().empty())) return std::nullopt;
  const SteadyTime start = clock_.SteadyNow();
  if (start < next_) return std::nullopt;
  measuring::Measurements all = Measure();
  const SteadyTime end = clock_.SteadyNow();
  next_ =
      std::max(end + FromSeconds(ToSeconds(end - start) / kMeasureCores), end + kMeasureInterval);
  return all;
}

}  // namespace isotherm
