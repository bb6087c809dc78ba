#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "ground/feedback/model_coverage.h"
#include "ground/feedback/reach.h"
#include "ground/feedback/view_outlook.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Describes a view that is worth taking.
struct NextView {
  RigidTransform T_map_depth;
  double gain_m2 = 0.0;  ///< Surface that it would measure well and that is not measured well yet.
  double unseen_m2 = 0.0;  ///< Outlook::unseen_m2.
  double firmness =
      0.0;  ///< Trackability::Firmness() there; 0 if the rig would be lost on the way.
};

/// Returns how long a person takes from one pose to another who walks carefully, seconds: at the
/// pace of the thesis's operator.
double WalkTime(const RigidTransform& from, const RigidTransform& to);

/// Finds the next best view: the pose that measures the most surface well for the first time per
/// second, with the way there, and where the rig can be tracked. Beyond the ends of the known
/// surface more is expected (SeenSpace). Candidates look at lacking surface
/// from a good distance, along its normal and at an angle. What each would see is found by casting
/// the model coarsely from there (ViewAssessor). A few candidates are tried per step. The best so
/// far is tried again each time, as the model grows; others are remembered with what they were
/// worth, and tried again when they would be the best. Thread-compatible.
class ViewPlanner {
 public:
  /// `rig` must have a thermal camera and its pose (CHECK). Voxels lighter than `min_weight` do not
  /// count as observed.
  ViewPlanner(const FeedbackOptions& options, const ThermalOptions& limits, const Rig& rig,
              float min_weight);

  /// Tries some candidates. `T_map_depth` is where the rig is: views are turned as it is held. A
  /// view that the rig has reached without any gain is not proposed again, nor is one that it did
  /// not go to in 150 steps (there may be no way). Only steps with `is_measuring` count: the rig is
  /// tracked, and temperatures are taken.
  void Step(const TsdfVolume& tsdf, const ThermalVolume& thermal, const ModelCoverage& coverage,
            const RigidTransform& T_map_depth, bool is_measuring, ThreadPool& pool);
  /// Takes that the rig has looked from there, too, into a scan volume with this grid.
  void NoteSeen(const RigidTransform& T_map_depth, const VoxelGrid& grid) {
    assessor_.NoteSeen(T_map_depth, grid);
  }
  /// Tracking was lost on the way to the best view: neither it nor one like it is proposed again.
  void GiveUpBest();

  const std::optional<NextView>& best() const { return best_; }

  /// Returns the surface of the model for which no view was found that would measure it well, or
  /// that several looks did not measure well, square metres.
  double OutOfReach(const ModelCoverage& coverage) const;

  /// Returns how much surface there may be that was never seen, as far as one view shows, square
  /// metres: of the views that were tried last, the one that shows most of it.
  double Unseen() const { return std::max(unseen_m2_, unseen_in_round_m2_); }

  /// Returns the surface that a view would measure well and that is not measured well yet, square
  /// metres; 0 where a camera would be inside or too close to something, or the depth camera would
  /// see too little to follow.
  double Gain(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
              const ThermalVolume& thermal, ThreadPool& pool);

 private:
  /// Holds a view that could be suggested.
  struct Candidate {
    RigidTransform T_map_depth;
    std::uint64_t cell;  ///< The LackingSurface that it looks at.
  };
  /// Groups the model, the rig's pose and the threads that a step works with.
  struct Model {
    const TsdfVolume& tsdf;
    const ThermalVolume& thermal;
    const RigidTransform& T_map_depth;
    ThreadPool& pool;
  };

  void MakeCandidates(const ModelCoverage& coverage, const RigidTransform& T_map_depth);
  /// Returns a pose that looks at `target` from the direction `towards_camera` (unit).
  RigidTransform LookAt(const Eigen::Vector3d& target, const Eigen::Vector3d& towards_camera,
                        const RigidTransform& T_map_depth) const;
  void NotePose(const RigidTransform& T_map_depth);
  void NoteWhatIsSeen(const Model& model);
  bool IsExhausted(const RigidTransform& T_map_depth) const;
  void Exhaust(const RigidTransform& T_map_depth);
  std::optional<NextView> Try(const RigidTransform& T_map_view, const Model& model);
  void TryBestAgain(const Model& model);
  /// Tries the view again that was worth most when it was remembered. Returns false if there is
  /// none that would be the best.
  bool TryKept(const Model& model);
  void TryNewCandidates(int count, const Model& model);
  /// Makes it the best view, or remembers it.
  void Offer(NextView view, const Model& model);
  void KeepForLater(const NextView& view, const RigidTransform& T_map_depth);
  /// Returns whether the rig can be tracked on the straight way there.
  bool HasWay(const RigidTransform& T_map_view, const Model& model);

  const FeedbackOptions options_;
  ViewAssessor assessor_;
  const double angle_min_rad_, angle_good_rad_;
  std::deque<Candidate> candidates_;
  Reach reach_;
  std::optional<NextView> best_;
  std::vector<NextView> kept_;
  std::optional<RigidTransform> T_map_depth_before_;
  double unseen_m2_ = 0.0;           ///< The most that Unseen() found in the last complete round.
  double unseen_in_round_m2_ = 0.0;  ///< The same, so far in this round.
  bool is_firm_here_ = false;        ///< The rig is tracked firmly where it is.
  int rounds_ = 0;                   ///< Rounds of candidates begun.
  int steps_at_best_ = 0;            ///< Steps that the rig has been at the best view.
  int steps_proposed_ = 0;           ///< Steps that the best view has been proposed.
  std::deque<RigidTransform> exhausted_;  ///< Views that gave nothing, or that nobody took.
};

}  // namespace isotherm
