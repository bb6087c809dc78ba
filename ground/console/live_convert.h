#pragma once

#include <optional>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/messages/messages.h"
#include "ground/console/live.pb.h"

namespace isotherm {

// From the types of the ground to those that the page gets.
measuring::Vector3 ToMessage(const Eigen::Vector3d& vector);
live::Pose ToMessage(const RigidTransform& pose);
live::Camera ToMessage(const CameraModel& camera);
live::Tracking ToMessage(TrackingState state);
live::Guidance ToMessage(const Feedback& feedback, double done_fraction);

Eigen::Vector3d FromMessage(const measuring::Vector3& vector);

/// The order to the rig that a client's order stands for; nullopt if it is none.
std::optional<Command> ToCommand(const live::Order& order);

}  // namespace isotherm
