#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "common/time/clock.h"
#include "ground/console/live.pb.h"
#include "ground/measuring/shape_measurer.h"
#include "ground/measuring/shape_store.h"
#include "ground/snapshot/model_copy.h"

namespace isotherm {

/// Holds what is measured on the model that the console shows: the list of shapes, their values as
/// the model grows, and questions about single places. Thread-bound to the console's thread.
class MeasureBoard {
 public:
  /// `clock` and `model` must outlive it.
  MeasureBoard(const Clock& clock, const ModelCopy& model) : clock_(clock), model_(model) {}

  /// Another model: begins with the shapes that are in its folder, if there are any.
  void Begin(const std::filesystem::path& folder, const MeasuringOptions& options);
  /// Blocks of the model have changed.
  void NoteModel() { is_model_new_ = true; }
  /// Changes the list and keeps it in the folder.
  Status Apply(const live::Edit& edit);
  measuring::VoxelRecord Answer(const live::Pick& pick);
  /// The list with its values if they have changed, no more often than is worth it.
  std::optional<measuring::Measurements> Update();
  /// Measures now.
  measuring::Measurements Measure();

  const measuring::ShapeList& shapes() const { return store_.shapes(); }

 private:
  /// nullptr while nothing is there to be measured on.
  ShapeMeasurer* Measurer();
  void Save() const;

  const Clock& clock_;
  const ModelCopy& model_;
  std::filesystem::path folder_;
  MeasuringOptions options_;
  ShapeStore store_;
  std::unique_ptr<ShapeMeasurer> measurer_;  ///< For the model as it is; nullptr once it changes.
  bool is_model_new_ = true;                 ///< Since the last measurement.
  bool are_shapes_new_ = true;
  SteadyTime next_;
};

}  // namespace isotherm
