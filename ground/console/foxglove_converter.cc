#include "ground/console/foxglove_converter.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstring>

#include "common/recording/foxglove.pb.h"
#include "common/recording/schema.h"
#include "ground/console/foxglove_scene.pb.h"
#include "ground/console/group_codec.h"
#include "ground/renderer/palette.h"
#include "ground/thermal/voxel_layout.h"

namespace isotherm {
namespace {

constexpr const char* kWorld = "world";
constexpr const char* kDepthFrame = "depth";
constexpr const char* kThermalFrame = "thermal";

/// A point of the cloud as it is sent.
struct CloudRow {
  float x, y, z;
  float celsius;  ///< NaN = never measured.
  std::uint8_t distance_class, angle_class, motion_class, disagreement_class;
};
static_assert(sizeof(CloudRow) == 20);

void SetTime(std::uint64_t time_ns, google::protobuf::Timestamp* time) {
  constexpr std::uint64_t kPerSecond = 1'000'000'000;
  time->set_seconds(static_cast<std::int64_t>(time_ns / kPerSecond));
  time->set_nanos(static_cast<std::int32_t>(time_ns % kPerSecond));
}

std::string MapName(std::uint32_t map) { return map == 0 ? kWorld : fmt::format("map_{}", map); }

void SetTransform(const live::Pose& pose, const std::string& parent, const std::string& child,
                  std::uint64_t time_ns, foxglove::FrameTransform* transform) {
  SetTime(time_ns, transform->mutable_timestamp());
  transform->set_parent_frame_id(parent);
  transform->set_child_frame_id(child);
  transform->mutable_translation()->set_x(pose.x());
  transform->mutable_translation()->set_y(pose.y());
  transform->mutable_translation()->set_z(pose.z());
  transform->mutable_rotation()->set_x(pose.qx());
  transform->mutable_rotation()->set_y(pose.qy());
  transform->mutable_rotation()->set_z(pose.qz());
  transform->mutable_rotation()->set_w(pose.qw());
}

/// The pose of b in a from that of a in b.
live::Pose Inverse(const live::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.qw(), pose.qx(), pose.qy(), pose.qz());
  const Eigen::Quaterniond back = rotation.conjugate();
  const Eigen::Vector3d shift = -(back * Eigen::Vector3d(pose.x(), pose.y(), pose.z()));
  live::Pose inverse;
  inverse.set_x(shift.x());
  inverse.set_y(shift.y());
  inverse.set_z(shift.z());
  inverse.set_qx(back.x());
  inverse.set_qy(back.y());
  inverse.set_qz(back.z());
  inverse.set_qw(back.w());
  return inverse;
}

FoxgloveData Calibration(const live::Camera& camera, FoxgloveTopic topic, const char* frame,
                         std::uint64_t time_ns) {
  foxglove::CameraCalibration message;
  SetTime(time_ns, message.mutable_timestamp());
  message.set_frame_id(frame);
  message.set_width(camera.width());
  message.set_height(camera.height());
  for (const double k :
       {camera.fx(), 0.0, camera.cx(), 0.0, camera.fy(), camera.cy(), 0.0, 0.0, 1.0})
    message.add_k(k);
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.add_r(r);
  for (const double p :
       {camera.fx(), 0.0, camera.cx(), 0.0, 0.0, camera.fy(), camera.cy(), 0.0, 0.0, 0.0, 1.0, 0.0})
    message.add_p(p);
  return {topic, time_ns, message.SerializeAsString()};
}

float CelsiusOf(std::uint16_t code) {
  return code == 0
             ? NAN
             : ThermalLayout::kMin_celsius + ThermalLayout::kStep_k * static_cast<float>(code - 1);
}

std::uint8_t ExportedClass(std::uint8_t classes, int shift) {
  return static_cast<std::uint8_t>(
      ThermalLayout::Decode(static_cast<std::uint32_t>(classes >> shift)));
}

template <typename Message>
FoxgloveChannel Channel(FoxgloveTopic topic, const char* name) {
  const google::protobuf::Descriptor& type = *Message::descriptor();
  return {.id = static_cast<std::uint32_t>(topic),
          .topic = name,
          .encoding = "protobuf",
          .schema_name = type.full_name(),
          .schema = recording::SerializedSchema(type),
          .schema_encoding = "protobuf"};
}

/// A group as it was before it was packed.
struct UnpackedGroup {
  std::vector<GroupVertex> vertices;
  std::vector<unsigned int> indices;
};
UnpackedGroup Unpack(const live::SurfaceGroup& group) {
  UnpackedGroup unpacked;
  unpacked.vertices.resize(group.vertex_count());
  unpacked.indices.resize(group.index_count());
  if (group.vertex_count() == 0) return unpacked;
  const auto bytes = [](const std::string& text) {
    return reinterpret_cast<const unsigned char*>(text.data());
  };
  // Our own bytes: they are whole.
  static_cast<void>(meshopt_decodeVertexBuffer(unpacked.vertices.data(), unpacked.vertices.size(),
                                               sizeof(GroupVertex), bytes(group.vertices()),
                                               group.vertices().size()));
  static_cast<void>(meshopt_decodeIndexBuffer(unpacked.indices.data(), unpacked.indices.size(),
                                              bytes(group.indices()), group.indices().size()));
  return unpacked;
}

}  // namespace

std::vector<FoxgloveChannel> FoxgloveChannels() {
  return {
      Channel<foxglove::RawImage>(FoxgloveTopic::kDepth, "/depth"),
      Channel<foxglove::RawImage>(FoxgloveTopic::kThermal, "/thermal"),
      Channel<foxglove::CameraCalibration>(FoxgloveTopic::kDepthCalibration, "/depth/calibration"),
      Channel<foxglove::CameraCalibration>(FoxgloveTopic::kThermalCalibration,
                                           "/thermal/calibration"),
      Channel<foxglove::FrameTransforms>(FoxgloveTopic::kTransforms, "/tf"),
      Channel<foxglove::PosesInFrame>(FoxgloveTopic::kPath, "/path"),
      Channel<foxglove::PointCloud>(FoxgloveTopic::kCloud, "/cloud"),
      Channel<foxglove::SceneUpdate>(FoxgloveTopic::kSurface, "/surface"),
      Channel<live::Guidance>(FoxgloveTopic::kGuidance, "/guidance"),
      Channel<foxglove::Log>(FoxgloveTopic::kLog, "/log")};
}

std::vector<FoxgloveData> FoxgloveConverter::Convert(const LiveMessage& message,
                                                     const Wants& wants) {
  std::vector<FoxgloveData> data;
  if (message.slot.kind == LiveKind::kRawDepth || message.slot.kind == LiveKind::kRawThermal) {
    const bool is_depth = message.slot.kind == LiveKind::kRawDepth;
    data.push_back({is_depth ? FoxgloveTopic::kDepth : FoxgloveTopic::kThermal, message.time_ns,
                    message.bytes});
    return data;
  }
  live::ServerMessage said;
  if (!said.ParseFromString(message.bytes)) return data;
  switch (said.content_case()) {
    case live::ServerMessage::kScan:
      Begin(said.scan(), wants, data);
      break;
    case live::ServerMessage::kMaps:
      maps_ = said.maps();
      break;
    case live::ServerMessage::kGroup:
      ConvertGroup(said.group(), wants, data);
      break;
    case live::ServerMessage::kPose:
      time_ns_ = said.pose().capture_time_ns();
      ConvertPose(said.pose(), data);
      break;
    case live::ServerMessage::kPath:
      ConvertPath(said.path(), data);
      break;
    case live::ServerMessage::kGuidance:
      ConvertGuidance(said.guidance(), wants, data);
      break;
    default:
      break;
  }
  std::erase_if(data, [&](const FoxgloveData& entry) { return !wants(entry.topic); });
  return data;
}

void FoxgloveConverter::Begin(const live::Scan& scan, const Wants& /*wants*/,
                              std::vector<FoxgloveData>& data) {
  if (scan.model() != scan_.model()) {
    foxglove::SceneUpdate update;
    foxglove::SceneEntityDeletion& deletion = *update.add_deletions();
    SetTime(time_ns_, deletion.mutable_timestamp());
    deletion.set_type(foxglove::SceneEntityDeletion::ALL);
    data.push_back({FoxgloveTopic::kSurface, time_ns_, update.SerializeAsString()});
    cloud_.clear();
    cloud_bytes_ = 0;
    is_cloud_new_ = true;
    coldest_celsius_ = 1e9F;
    hottest_celsius_ = -1e9F;
  }
  scan_ = scan;
  if (scan.has_depth())
    data.push_back(
        Calibration(scan.depth(), FoxgloveTopic::kDepthCalibration, kDepthFrame, time_ns_));
  if (scan.has_thermal()) {
    data.push_back(
        Calibration(scan.thermal(), FoxgloveTopic::kThermalCalibration, kThermalFrame, time_ns_));
  }
}

void FoxgloveConverter::ConvertPose(const live::RigPose& pose,
                                    std::vector<FoxgloveData>& data) const {
  foxglove::FrameTransforms transforms;
  const std::uint64_t time_ns = pose.capture_time_ns();
  for (int i = 1; i < maps_.maps_size(); ++i) {
    if (!maps_.maps(i).joined()) continue;
    SetTransform(maps_.maps(i).t_world_map(), kWorld, MapName(static_cast<std::uint32_t>(i)),
                 time_ns, transforms.add_transforms());
  }
  if (pose.tracking() != live::LOST)
    SetTransform(pose.t_map_depth(), MapName(pose.map()), kDepthFrame, time_ns,
                 transforms.add_transforms());
  if (scan_.has_t_thermal_depth()) {
    // T_depth_thermal: the pose of the thermal camera in the coordinates of the depth camera.
    SetTransform(Inverse(scan_.t_thermal_depth()), kDepthFrame, kThermalFrame, time_ns,
                 transforms.add_transforms());
  }
  data.push_back({FoxgloveTopic::kTransforms, time_ns, transforms.SerializeAsString()});
}

void FoxgloveConverter::ConvertPath(const live::Path& path, std::vector<FoxgloveData>& data) const {
  foxglove::PosesInFrame poses;
  SetTime(time_ns_, poses.mutable_timestamp());
  poses.set_frame_id(kWorld);
  for (const live::Path::Part& part : path.parts()) {
    if (static_cast<int>(part.map()) >= maps_.maps_size()) continue;
    const live::Pose& map = maps_.maps(static_cast<int>(part.map())).t_world_map();
    const Eigen::Quaterniond rotation(map.qw(), map.qx(), map.qy(), map.qz());
    for (int i = 0; i + 2 < part.positions_size(); i += 3) {
      const Eigen::Vector3d p = rotation * Eigen::Vector3d(part.positions(i), part.positions(i + 1),
                                                           part.positions(i + 2)) +
                                Eigen::Vector3d(map.x(), map.y(), map.z());
      foxglove::Pose& pose = *poses.add_poses();
      pose.mutable_position()->set_x(p.x());
      pose.mutable_position()->set_y(p.y());
      pose.mutable_position()->set_z(p.z());
      pose.mutable_orientation()->set_w(1.0);
    }
  }
  data.push_back({FoxgloveTopic::kPath, time_ns_, poses.SerializeAsString()});
}

void FoxgloveConverter::ConvertGuidance(const live::Guidance& guidance, const Wants& /*wants*/,
                                        std::vector<FoxgloveData>& data) {
  data.push_back({FoxgloveTopic::kGuidance, time_ns_, guidance.SerializeAsString()});
  const std::string& text = guidance.advice();
  if (text == told_) return;
  told_ = text;
  foxglove::Log log;
  SetTime(time_ns_, log.mutable_timestamp());
  log.set_level(guidance.tracking() == live::LOST ? foxglove::Log::WARNING : foxglove::Log::INFO);
  log.set_name("isotherm");
  log.set_message(text.empty()
                      ? "go on scanning"
                      : text + (guidance.reason().empty() ? "" : ": " + guidance.reason()));
  data.push_back({FoxgloveTopic::kLog, time_ns_, log.SerializeAsString()});
}

void FoxgloveConverter::ConvertGroup(const live::SurfaceGroup& group, const Wants& wants,
                                     std::vector<FoxgloveData>& data) {
  const GroupKey key = FromMessage(group.key());
  const std::string id = fmt::format("{}/{}/{}/{}", key.map, key.x, key.y, key.z);
  const UnpackedGroup unpacked = Unpack(group);
  foxglove::SceneUpdate update;
  foxglove::TriangleListPrimitive* triangles = nullptr;
  if (unpacked.vertices.empty()) {
    foxglove::SceneEntityDeletion& deletion = *update.add_deletions();
    SetTime(time_ns_, deletion.mutable_timestamp());
    deletion.set_id(id);
  } else {
    foxglove::SceneEntity& entity = *update.add_entities();
    SetTime(time_ns_, entity.mutable_timestamp());
    entity.set_frame_id(MapName(group.key().map()));
    entity.set_id(id);
    triangles = entity.add_triangles();
    triangles->mutable_pose()->mutable_orientation()->set_w(1.0);
  }
  std::string rows;
  rows.reserve(unpacked.vertices.size() * sizeof(CloudRow));
  for (const GroupVertex& vertex : unpacked.vertices) {
    const float celsius = CelsiusOf(vertex.temperature);
    if (celsius < coldest_celsius_) coldest_celsius_ = celsius;
    if (celsius > hottest_celsius_) hottest_celsius_ = celsius;
    const CloudRow row{
        .x = static_cast<float>(group.origin().x() + group.scale() * vertex.position[0]),
        .y = static_cast<float>(group.origin().y() + group.scale() * vertex.position[1]),
        .z = static_cast<float>(group.origin().z() + group.scale() * vertex.position[2]),
        .celsius = celsius,
        .distance_class = ExportedClass(vertex.classes, 0),
        .angle_class = ExportedClass(vertex.classes, 2),
        .motion_class = ExportedClass(vertex.classes, 4),
        .disagreement_class = ExportedClass(vertex.classes, 6)};
    rows.append(reinterpret_cast<const char*>(&row), sizeof(row));
    foxglove::Point3& point = *triangles->add_points();
    point.set_x(row.x);
    point.set_y(row.y);
    point.set_z(row.z);
    const double fraction = (celsius - coldest_celsius_) /
                            std::max(0.1, static_cast<double>(hottest_celsius_ - coldest_celsius_));
    const Rgb8 rgb =
        std::isnan(celsius) ? Rgb8{90, 96, 106} : IronColour(std::clamp(fraction, 0.0, 1.0));
    foxglove::Color& colour = *triangles->add_colors();
    colour.set_r(rgb.r / 255.0);
    colour.set_g(rgb.g / 255.0);
    colour.set_b(rgb.b / 255.0);
    colour.set_a(1.0);
  }
  for (const unsigned int index : unpacked.indices) triangles->add_indices(index);
  if (wants(FoxgloveTopic::kSurface))
    data.push_back({FoxgloveTopic::kSurface, time_ns_, update.SerializeAsString()});
  std::string& kept = cloud_[key];
  cloud_bytes_ += rows.size();
  cloud_bytes_ -= kept.size();
  kept = std::move(rows);
  is_cloud_new_ = true;
}

std::optional<FoxgloveData> FoxgloveConverter::TakeCloud() {
  if (!is_cloud_new_) return std::nullopt;
  is_cloud_new_ = false;
  foxglove::PointCloud cloud;
  SetTime(time_ns_, cloud.mutable_timestamp());
  cloud.set_frame_id(kWorld);
  cloud.mutable_pose()->mutable_orientation()->set_w(1.0);
  cloud.set_point_stride(sizeof(CloudRow));
  const auto field = [&](const char* name, std::size_t offset,
                         foxglove::PackedElementField::NumericType type) {
    foxglove::PackedElementField& entry = *cloud.add_fields();
    entry.set_name(name);
    entry.set_offset(static_cast<std::uint32_t>(offset));
    entry.set_type(type);
  };
  field("x", offsetof(CloudRow, x), foxglove::PackedElementField::FLOAT32);
  field("y", offsetof(CloudRow, y), foxglove::PackedElementField::FLOAT32);
  field("z", offsetof(CloudRow, z), foxglove::PackedElementField::FLOAT32);
  field("temperature", offsetof(CloudRow, celsius), foxglove::PackedElementField::FLOAT32);
  field("distance_class", offsetof(CloudRow, distance_class), foxglove::PackedElementField::UINT8);
  field("angle_class", offsetof(CloudRow, angle_class), foxglove::PackedElementField::UINT8);
  field("motion_class", offsetof(CloudRow, motion_class), foxglove::PackedElementField::UINT8);
  field("disagreement_class", offsetof(CloudRow, disagreement_class),
        foxglove::PackedElementField::UINT8);
  cloud.mutable_data()->reserve(cloud_bytes_);
  // One cloud has one coordinate frame: that of the sub-map in which the rig is.
  for (const auto& [key, rows] : cloud_) {
    if (key.map == static_cast<int>(maps_.active())) cloud.mutable_data()->append(rows);
  }
  cloud.set_frame_id(MapName(maps_.active()));
  return FoxgloveData{FoxgloveTopic::kCloud, time_ns_, cloud.SerializeAsString()};
}

}  // namespace isotherm
