#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/map_pose.h"
#include "common/geometry/rigid_transform.h"
#include "ground/icp/observability.h"

namespace isotherm {

/// Holds what temperatures add to the motion along directions that the geometry cannot measure.
struct ThermalFit {
  /// Maps the unobservable axes to new ones, orthonormal columns, the observed ones last.
  Eigen::MatrixXd rotation;
  int observed = 0;             ///< The last columns, which temperatures observe.
  Eigen::VectorXd variance_m2;  ///< Along each of those.
};

/// Measures motions that the geometry does not: in front of a bare wall, the newest thermal image
/// is laid over one from before, the reference, whose temperatures belong to points of the model.
/// The idea is that of T-ICP (Cao et al., "Depth and thermal sensor fusion to enhance 3D
/// thermographic reconstruction", Optics Express 26, 2018); here geometry keeps the directions that
/// it observes, so that kelvins need no weight against metres. What counts are differences within a
/// image, not its level, which shutter events and the camera's temperature move. Works on
/// images of a quarter of the size, where the noise is a quarter. Thread-compatible.
class ThermalAlignment {
 public:
  /// `min_gradient_k_m`: the standard deviation over the image of the change of temperature per
  /// shift of the surface, from which a direction is observed.
  ThermalAlignment(const CameraModel& thermal_camera, const RigidTransform& T_thermal_depth,
                   double min_gradient_k_m, double prior_sigma_m_s);

  /// A valid thermal frame of the camera's size. Before the first depth frame after it.
  void Add(ThermalFramePtr frame) { newest_ = std::move(frame); }

  /// A depth frame of `time` is going to be tracked, near `guess`; `last` is the one before.
  void Begin(const std::optional<StampedMapPose>& last, CaptureTime time,
             const RigidTransform& guess);
  /// Moves the depth frame's pose along the unobservable axes of `motion` as far as temperatures
  /// observe them; nullopt and no move if they do not, or if there is nothing to compare.
  /// `model_points`: maps in `map` from the last pose.
  std::optional<ThermalFit> Align(const Observability& motion, const SurfaceMaps& model_points,
                                  RigidTransform& T_map_depth);
  /// The depth frame was tracked: `last` is its pose and `before` the one before that, if it is
  /// known. `sigma_m`: how far the surface may be off in the image.
  void End(const std::optional<StampedMapPose>& before, const StampedMapPose& last, double sigma_m);
  /// Tracking was lost.
  void Forget();

 private:
  /// A point of the model and what was measured there.
  struct Sample {
    Eigen::Vector3d p_map;
    double celsius;
    Eigen::Vector3d
        gradient;  ///< Change of the temperature with the point's motion, K/m, in `map`.
  };
  struct Sums;

  /// Returns what an image shows at a point; nullopt outside of it.
  std::optional<Sample> Look(const Image<float>& celsius, const RigidTransform& T_map_thermal,
                             const Eigen::Vector3d& p_map) const;
  /// The quarter image without lens distortion, °C; NaN = no value.
  void Reduce(const ThermalFrame& frame, Image<float>& celsius) const;
  void MakeReference(const SurfaceMaps& model_points);
  /// Mean products of the shifts of the reference's points per motion along the axes.
  Matrix6 Shifts(const RigidTransform& T_map_depth, const Observability& motion) const;
  /// Separates directions by the mean square of the temperature's change per shift, and returns
  /// that per motion.
  Eigen::VectorXd FindObserved(const Eigen::MatrixXd& H, const Eigen::MatrixXd& shifts,
                               ThermalFit& fit) const;
  /// Along all axes. `last`: the sums at the pose before, if there were any; what is far from them
  /// is left out.
  Sums Accumulate(const RigidTransform& T_map_depth, const Observability& motion, const Sums& last);

  CameraModel camera_;                ///< The camera of the quarter image.
  std::vector<std::int32_t> source_;  ///< Its cells' pixels in the camera's image, 16 each.
  const RigidTransform T_depth_thermal_;
  const double min_gradient_k_m_;
  const double prior_sigma_m_s_;

  ThermalFramePtr newest_;
  ThermalFramePtr placed_;  ///< The newest one whose pose is known.
  RigidTransform T_map_placed_;
  double placed_sigma_m_ = 0.0;

  std::vector<Sample> reference_;
  double reference_sigma_m_ = 0.0;
  double reference_variance_k2_ = 0.0;  ///< Variance of the reference's temperatures.
  bool reference_leaves_view_ = false;

  /// since_gap_ counts up to here: 0 = not measured now, 1 = the first frame that is again, 2 =
  /// longer ago.
  static constexpr int kNoGap = 2;
  /// Frames since unobservable directions were not measured.
  int since_gap_ = kNoGap;

  // About the depth frame that is tracked.
  bool has_image_ = false;  ///< The newest frame was taken since the depth frame before.
  bool is_reduced_ = false;
  bool was_wanted_ = false;
  bool was_measured_ = false;
  double behind_s_ = 0.0;        ///< Time from the thermal to the depth frame.
  RigidTransform T_depth_then_;  ///< The depth camera's motion in that time, backwards.
  Image<float> image_;
  std::vector<double> residuals_;  ///< Scratch.
};

}  // namespace isotherm
