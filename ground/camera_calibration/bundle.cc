#include "ground/camera_calibration/bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>

#include "ground/camera_calibration/bundle_priors.h"
#include "ground/camera_calibration/lens_rays.h"

namespace isotherm {
namespace {

constexpr int kPose = 6;  ///< Rotation vector, translation.
constexpr int kOffset = 2;

using PoseParameters = std::array<double, kPose>;

PoseParameters ToParameters(const RigidTransform& pose) {
  const Eigen::AngleAxisd rotation(pose.linear());
  const Eigen::Vector3d vector = rotation.angle() * rotation.axis();
  const Eigen::Vector3d t = pose.translation();
  return {vector.x(), vector.y(), vector.z(), t.x(), t.y(), t.z()};
}

RigidTransform FromParameters(const PoseParameters& p) {
  const Eigen::Vector3d vector(p[0], p[1], p[2]);
  const double angle = vector.norm();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  if (angle > 0.0) rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
  return MakeTransform({p[3], p[4], p[5]}, rotation);
}

/// Where the features are as drawn, and how `a` and `b` of BoardShape follow.
struct BoardPlace {
  Eigen::Vector2d xy;
  Eigen::Vector2d middle;
  Eigen::Vector2d half;
};

template <typename T>
void BoardPoint(const BoardPlace& place, const T* warp, const T* offset, double behind_m, T* p) {
  p[0] = T(place.xy.x()) + offset[0];
  p[1] = T(place.xy.y()) + offset[1];
  const T a = (p[0] - place.middle.x()) / place.half.x();
  const T b = (p[1] - place.middle.y()) / place.half.y();
  p[2] = BoardShape::WarpZ(warp, a, b) + behind_m;
}

template <typename T>
void Transform(const T* pose, const T* in, T* out) {
  ceres::AngleAxisRotatePoint(pose, in, out);
  for (int i = 0; i < 3; ++i) out[i] += pose[3 + i];
}

/// Seen minus predicted, over its standard deviation.
class ReprojectionCost {
 public:
  ReprojectionCost(LensKind kind, const BoardPlace& place, const FeatureObservation& observation)
      : kind_(kind), place_(place), pixel_(observation.pixel) {
    const Eigen::LLT<Eigen::Matrix2d> llt(observation.covariance);
    whitening_ = llt.matrixL().solve(Eigen::Matrix2d::Identity());
  }

  template <typename T>
  bool operator()(const T* lens, const T* camera_pose, const T* view_pose, const T* warp,
                  const T* offset, T* residual) const {
    T board[3], rig[3], camera[3], pixel[2];
    BoardPoint(place_, warp, offset, 0.0, board);
    Transform(view_pose, board, rig);
    Transform(camera_pose, rig, camera);
    if (!ProjectLens(kind_, lens, camera, pixel)) return false;
    const T du = pixel_.x() - pixel[0], dv = pixel_.y() - pixel[1];
    residual[0] = whitening_(0, 0) * du;
    residual[1] = whitening_(1, 0) * du + whitening_(1, 1) * dv;
    return true;
  }

 private:
  const LensKind kind_;
  const BoardPlace place_;
  const Eigen::Vector2d pixel_;
  Eigen::Matrix2d whitening_;
};

/// Keeps parameters near 0: parameter over its standard deviation.
template <int kSize>
class PriorCost {
 public:
  explicit PriorCost(const std::array<double, kSize>& sigma) : sigma_(sigma) {}
  template <typename T>
  bool operator()(const T* value, T* residual) const {
    for (int i = 0; i < kSize; ++i) residual[i] = value[i] / sigma_[static_cast<std::size_t>(i)];
    return true;
  }

 private:
  const std::array<double, kSize> sigma_;
};

/// The parameters in the order and form that Ceres works on, and the problem over them.
class BundleProblem {
 public:
  BundleProblem(const CalibrationTarget& target,
                const std::vector<FeatureObservation>& observations, const BundleOptions& options,
                const BundleState& state)
      : target_(target), options_(options), cameras_(state.cameras), warp_(state.board.warp_m) {
    for (const BundleCamera& camera : cameras_) {
      lenses_.push_back(camera.lens);
      camera_poses_.push_back(ToParameters(camera.T_camera_rig));
    }
    for (const RigidTransform& pose : state.T_rig_board) view_poses_.push_back(ToParameters(pose));
    offsets_.resize(static_cast<std::size_t>(target.features()), {0.0, 0.0});
    for (std::size_t i = 0; i < state.board.offsets_m.size(); ++i)
      offsets_[i] = {state.board.offsets_m[i].x(), state.board.offsets_m[i].y()};
    AddBlocks();
    for (const FeatureObservation& observation : observations) Add(observation);
    AddPriors();
  }

  ceres::Problem& problem() { return problem_; }
  const std::vector<ceres::ResidualBlockId>& observations() const { return observation_ids_; }
  const std::vector<ceres::ResidualBlockId>& priors() const { return prior_ids_; }

  void CopyTo(BundleState& state) const {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      state.cameras[i].lens = lenses_[i];
      state.cameras[i].T_camera_rig = FromParameters(camera_poses_[i]);
    }
    for (std::size_t i = 0; i < view_poses_.size(); ++i)
      state.T_rig_board[i] = FromParameters(view_poses_[i]);
    state.board.warp_m = warp_;
    state.board.offsets_m.resize(offsets_.size());
    for (std::size_t i = 0; i < offsets_.size(); ++i)
      state.board.offsets_m[i] = {offsets_[i][0], offsets_[i][1]};
  }

  /// The blocks that all views share, in the order of ReducedSystem, and where they begin.
  std::vector<double*> SharedBlocks(ReducedSystem& system) {
    std::vector<double*> blocks;
    const auto add = [&](double* block) {
      if (problem_.IsParameterBlockConstant(block)) return -1;
      blocks.push_back(block);
      const int at = system.shared;
      system.shared += problem_.ParameterBlockTangentSize(block);
      return at;
    };
    for (auto& lens : lenses_) system.lens_at.push_back(add(lens.data()));
    for (auto& pose : camera_poses_) system.pose_at.push_back(add(pose.data()));
    add(warp_.data());
    for (auto& offset : offsets_) add(offset.data());
    return blocks;
  }
  double* ViewBlock(std::size_t view) { return view_poses_[view].data(); }
  std::size_t views() const { return view_poses_.size(); }
  /// How many values the observations alone determine: those that have no prior.
  int FreeParameters() const {
    auto count = static_cast<int>(kPose * (view_poses_.size() + cameras_.size() - 1));
    if (options_.fix_lenses) return count;
    for (const BundleCamera& camera : cameras_) count += FreeLensParameters(camera.kind);
    return count;
  }

 private:
  void AddBlocks() {
    for (std::size_t i = 0; i < lenses_.size(); ++i) {
      const int count = LensParameterCount(cameras_[i].kind);
      std::vector<int> unused;
      for (int j = count; j < kMaxLensParameters; ++j) unused.push_back(j);
      problem_.AddParameterBlock(lenses_[i].data(), kMaxLensParameters);
      if (!unused.empty())
        problem_.SetManifold(lenses_[i].data(),
                             new ceres::SubsetManifold(kMaxLensParameters, unused));
      if (options_.fix_lenses) problem_.SetParameterBlockConstant(lenses_[i].data());
      problem_.AddParameterBlock(camera_poses_[i].data(), kPose);
      if (i == 0) problem_.SetParameterBlockConstant(camera_poses_[i].data());
    }
    for (auto& pose : view_poses_) problem_.AddParameterBlock(pose.data(), kPose);
    problem_.AddParameterBlock(warp_.data(), BoardShape::kWarpTerms);
    if (!options_.estimate_board) problem_.SetParameterBlockConstant(warp_.data());
    for (auto& offset : offsets_) {
      problem_.AddParameterBlock(offset.data(), kOffset);
      if (!HasPlacement()) problem_.SetParameterBlockConstant(offset.data());
    }
  }

  bool HasPlacement() const { return options_.estimate_board && target_.placement_sigma_m > 0.0; }

  void Add(const FeatureObservation& observation) {
    using Cost = ceres::AutoDiffCostFunction<ReprojectionCost, 2, kMaxLensParameters, kPose, kPose,
                                             BoardShape::kWarpTerms, kOffset>;
    const auto camera = static_cast<std::size_t>(observation.camera);
    const BoardPlace place = {target_.FeaturePosition(observation.feature), target_.Middle(),
                              target_.HalfSize()};
    observation_ids_.push_back(problem_.AddResidualBlock(
        new Cost(new ReprojectionCost(cameras_[camera].kind, place, observation)),
        new ceres::HuberLoss(options_.robust_sigmas), lenses_[camera].data(),
        camera_poses_[camera].data(),
        view_poses_[static_cast<std::size_t>(observation.view)].data(), warp_.data(),
        offsets_[static_cast<std::size_t>(observation.feature)].data()));
  }

  void AddLensPriors() {
    using Prior = PriorCost<kMaxLensParameters>;
    using Cost = ceres::AutoDiffCostFunction<Prior, kMaxLensParameters, kMaxLensParameters>;
    for (std::size_t i = 0; i < lenses_.size(); ++i) {
      const LensKind kind = cameras_[i].kind;
      if (options_.fix_lenses || kind == LensKind::kBrownConrady) continue;
      prior_ids_.push_back(problem_.AddResidualBlock(new Cost(new Prior(LensSigmas(kind))), nullptr,
                                                     lenses_[i].data()));
    }
  }

  void AddPriors() {
    AddLensPriors();
    if (!options_.estimate_board) return;
    using WarpPrior = PriorCost<BoardShape::kWarpTerms>;
    using WarpCost =
        ceres::AutoDiffCostFunction<WarpPrior, BoardShape::kWarpTerms, BoardShape::kWarpTerms>;
    if (target_.warp_sigma_m > 0.0) {
      prior_ids_.push_back(problem_.AddResidualBlock(
          new WarpCost(new WarpPrior(WarpSigmas(target_))), nullptr, warp_.data()));
    } else {
      problem_.SetParameterBlockConstant(warp_.data());
    }
    if (!HasPlacement()) return;
    using OffsetPrior = PriorCost<kOffset>;
    using OffsetCost = ceres::AutoDiffCostFunction<OffsetPrior, kOffset, kOffset>;
    for (auto& offset : offsets_) {
      prior_ids_.push_back(problem_.AddResidualBlock(
          new OffsetCost(new OffsetPrior({target_.placement_sigma_m, target_.placement_sigma_m})),
          nullptr, offset.data()));
    }
  }

  const CalibrationTarget& target_;
  const BundleOptions options_;
  const std::vector<BundleCamera> cameras_;
  std::vector<LensParameters> lenses_;
  std::vector<PoseParameters> camera_poses_, view_poses_;
  std::array<double, BoardShape::kWarpTerms> warp_;
  std::vector<std::array<double, kOffset>> offsets_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> observation_ids_, prior_ids_;
};

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Residuals and dense Jacobian of some residual blocks with respect to some parameter blocks.
struct Linearization {
  Eigen::VectorXd residuals;
  RowMatrix jacobian;
};

Linearization Linearize(ceres::Problem& problem, const std::vector<ceres::ResidualBlockId>& rows,
                        const std::vector<double*>& columns) {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = rows;
  options.parameter_blocks = columns;
  std::vector<double> residuals;
  ceres::CRSMatrix sparse;
  problem.Evaluate(options, nullptr, &residuals, nullptr, &sparse);
  Linearization result;
  result.residuals =
      Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
  result.jacobian = RowMatrix::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int i = sparse.rows[static_cast<std::size_t>(row)];
         i < sparse.rows[static_cast<std::size_t>(row) + 1]; ++i)
      result.jacobian(row, sparse.cols[static_cast<std::size_t>(i)]) =
          sparse.values[static_cast<std::size_t>(i)];
  }
  return result;
}

/// Returns what one view says about the shared parameters, its pose eliminated.
ReducedSystem::Term Reduce(const Linearization& linear, int shared) {
  const Eigen::MatrixXd a = linear.jacobian.leftCols(shared);
  const Eigen::MatrixXd b = linear.jacobian.rightCols(kPose);
  const Eigen::LDLT<Eigen::MatrixXd> pose(b.transpose() * b);
  const Eigen::MatrixXd cross = b.transpose() * a;
  ReducedSystem::Term term;
  term.hessian = a.transpose() * a - cross.transpose() * pose.solve(cross);
  term.gradient = a.transpose() * linear.residuals -
                  cross.transpose() * pose.solve(b.transpose() * linear.residuals);
  return term;
}

BundleFit Fit(BundleProblem& bundle, const std::vector<FeatureObservation>& observations) {
  BundleFit fit;
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = bundle.observations();
  options.apply_loss_function = false;
  std::vector<double> whitened;
  bundle.problem().Evaluate(options, nullptr, &whitened, nullptr, nullptr);
  double sum = 0.0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Eigen::Vector2d w(whitened[2 * i], whitened[2 * i + 1]);
    sum += w.squaredNorm();
    const Eigen::LLT<Eigen::Matrix2d> llt(observations[i].covariance);
    fit.residuals_px.emplace_back(llt.matrixL() * w);
  }
  const double freedom = 2.0 * static_cast<double>(observations.size()) - bundle.FreeParameters();
  fit.variance_factor = freedom > 0.0 ? sum / freedom : 1.0;
  return fit;
}

}  // namespace

Eigen::MatrixXd ReducedSystem::Covariance() const {
  Eigen::MatrixXd hessian = prior.hessian;
  for (const Term& view : views) hessian += view.hessian;
  return hessian.ldlt().solve(Eigen::MatrixXd::Identity(shared, shared));
}

Eigen::VectorXd ReducedSystem::Step(const std::vector<double>& weights) const {
  Eigen::MatrixXd hessian = prior.hessian;
  Eigen::VectorXd gradient = prior.gradient;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (weights[i] == 0.0) continue;
    hessian += weights[i] * views[i].hessian;
    gradient += weights[i] * views[i].gradient;
  }
  return -hessian.ldlt().solve(gradient);
}

Eigen::Vector2d ProjectBoardPoint(const BundleState& state, const CalibrationTarget& target,
                                  int camera, int view, int feature,
                                  const Eigen::Vector2d& offset_m, double behind_m) {
  const BundleCamera& c = state.cameras[static_cast<std::size_t>(camera)];
  const auto index = static_cast<std::size_t>(feature);
  Eigen::Vector2d offset = offset_m;
  if (index < state.board.offsets_m.size()) offset += state.board.offsets_m[index];
  const BoardPlace place = {target.FeaturePosition(feature), target.Middle(), target.HalfSize()};
  Eigen::Vector3d p;
  BoardPoint(place, state.board.warp_m.data(), offset.data(), behind_m, p.data());
  const Eigen::Vector3d p_camera =
      c.T_camera_rig * (state.T_rig_board[static_cast<std::size_t>(view)] * p);
  return ProjectRay(c.kind, c.lens, p_camera);
}

Result<BundleFit> SolveBundle(const CalibrationTarget& target,
                              const std::vector<FeatureObservation>& observations,
                              const BundleOptions& options, BundleState& state) {
  BundleProblem bundle(target, observations, options, state);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> blocks;
  bundle.problem().GetParameterBlocks(&blocks);
  for (double* block : blocks) ordering->AddElementToGroup(block, 1);
  for (std::size_t view = 0; view < bundle.views(); ++view)
    ordering->AddElementToGroup(bundle.ViewBlock(view), 0);
  solver.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &bundle.problem(), &summary);
  if (!summary.IsSolutionUsable()) {
    return Err(FailedPrecondition(
        fmt::format("no camera explains these images of the target ({})", summary.message)));
  }
  bundle.CopyTo(state);
  BundleFit fit = Fit(bundle, observations);
  fit.iterations = static_cast<int>(summary.iterations.size());
  return fit;
}

Result<ReducedSystem> ReduceBundle(const CalibrationTarget& target,
                                   const std::vector<FeatureObservation>& observations,
                                   const BundleOptions& options, const BundleState& state) {
  BundleProblem bundle(target, observations, options, state);
  ReducedSystem system;
  const std::vector<double*> shared = bundle.SharedBlocks(system);
  for (std::size_t view = 0; view < bundle.views(); ++view) {
    std::vector<ceres::ResidualBlockId> rows;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      if (observations[i].view == static_cast<int>(view)) rows.push_back(bundle.observations()[i]);
    }
    if (rows.empty())
      return Err(FailedPrecondition(fmt::format("view {} has no features left", view)));
    std::vector<double*> columns = shared;
    columns.push_back(bundle.ViewBlock(view));
    system.views.push_back(Reduce(Linearize(bundle.problem(), rows, columns), system.shared));
  }
  system.prior = {Eigen::MatrixXd::Zero(system.shared, system.shared),
                  Eigen::VectorXd::Zero(system.shared)};
  if (!bundle.priors().empty()) {
    const Linearization prior = Linearize(bundle.problem(), bundle.priors(), shared);
    system.prior.hessian = prior.jacobian.transpose() * prior.jacobian;
    system.prior.gradient = prior.jacobian.transpose() * prior.residuals;
  }
  return system;
}

}  // namespace isotherm
