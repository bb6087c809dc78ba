// Names that options once had: whoever has them in a file learns the present ones.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "common/options/override.h"
#include "common/options/renamed_options.h"
#include "common/options/text_proto.h"
#include "common/rig/rig_calibration.pb.h"
#include "common/simulation/simulation_options.pb.h"
#include "edge/options/edge_options.pb.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

namespace pb = google::protobuf;
using ::testing::HasSubstr;

/// A message type within a program's options, and where it stands there.
struct Place {
  const pb::Descriptor* type;
  std::string path;  ///< "tracker.external_odometry".
};

void Collect(const Place& place, std::vector<Place>& places) {
  places.push_back(place);
  for (int i = 0; i < place.type->field_count(); ++i) {
    const pb::FieldDescriptor& field = *place.type->field(i);
    if (field.message_type() == nullptr || field.is_repeated()) continue;
    const std::string prefix = place.path.empty() ? "" : place.path + ".";
    Collect({field.message_type(), prefix + field.name()}, places);
  }
}

std::vector<Place> PlacesIn(const pb::Message& options) {
  std::vector<Place> places;
  Collect({options.GetDescriptor(), ""}, places);
  return places;
}

const pb::FieldDescriptor* FindField(const pb::Descriptor& root, std::string_view path) {
  const pb::Descriptor* type = &root;
  while (type != nullptr) {
    const std::string name(path.substr(0, path.find('.')));
    const pb::FieldDescriptor* field = type->FindFieldByName(name);
    if (field == nullptr || name.size() == path.size()) return field;
    type = field->message_type();
    path.remove_prefix(name.size() + 1);
  }
  return nullptr;
}

template <typename Options>
class OptionNamesTest : public ::testing::Test {
 protected:
  Options options_;
};

using Programs = ::testing::Types<GroundOptions, EdgeOptions, SimulationOptions>;
TYPED_TEST_SUITE(OptionNamesTest, Programs);

/// The list of old names is that of the .proto files, so a name that is reserved there and has no
/// present one fails here.
TYPED_TEST(OptionNamesTest, EachNameThatWasGivenUpFailsWithThePresentOne) {
  int names = 0;
  for (const Place& place : PlacesIn(this->options_)) {
    for (int i = 0; i < place.type->reserved_name_count(); ++i) {
      const std::string& before = place.type->reserved_name(i);
      const RenamedOption* renamed = FindRenamed(*place.type, before);
      ASSERT_NE(renamed, nullptr) << place.type->full_name() << " " << before;
      ++names;
      const std::string prefix = place.path.empty() ? "" : place.path + ".";
      const bool in_rig = renamed->place == RenamedOption::Place::kRigFile;
      const std::string said = in_rig ? fmt::format("'{}' of the rig file", renamed->now)
                                      : fmt::format("'{}{}' now", prefix, renamed->now);
      TypeParam options;
      EXPECT_THAT(ApplyOverride(prefix + before + "=1", options).message(), HasSubstr(said));
      std::string text = before + ": 1", closing;
      for (std::string_view rest = place.path; !rest.empty();) {
        const std::size_t dot = rest.rfind('.');
        const std::size_t begin = dot == std::string_view::npos ? 0 : dot + 1;
        text = fmt::format("{} {{ {} }}", rest.substr(begin), text);
        rest = rest.substr(0, dot == std::string_view::npos ? 0 : dot);
      }
      EXPECT_THAT(ParseTextProto(text, "old.textproto", options).message(),
                  HasSubstr(fmt::format("'{}'", renamed->now)))
          << text;
    }
  }
  EXPECT_GT(names, 10);
}

/// And each present name must be one.
TYPED_TEST(OptionNamesTest, EachPresentNameExists) {
  for (const Place& place : PlacesIn(this->options_)) {
    for (const RenamedOption& renamed : RenamedOptions()) {
      if (renamed.type != place.type->name()) continue;
      const pb::Descriptor& root = renamed.place == RenamedOption::Place::kRigFile
                                       ? *RigCalibration::descriptor()
                                       : *place.type;
      EXPECT_NE(FindField(root, renamed.now), nullptr) << renamed.type << ": " << renamed.now;
    }
  }
}

TEST(RenamedOptionsTest, EachOldNameIsReservedWhereItWas) {
  std::set<std::pair<std::string, std::string>> reserved;
  for (const std::vector<Place>& places :
       {PlacesIn(GroundOptions()), PlacesIn(EdgeOptions()), PlacesIn(SimulationOptions())}) {
    for (const Place& place : places) {
      for (int i = 0; i < place.type->reserved_name_count(); ++i)
        reserved.insert({place.type->name(), place.type->reserved_name(i)});
    }
  }
  for (const RenamedOption& renamed : RenamedOptions()) {
    EXPECT_TRUE(reserved.contains({std::string(renamed.type), std::string(renamed.before)}))
        << renamed.type << ": " << renamed.before << " could be given to another option";
  }
}

TEST(OverrideTest, EachAssignmentAddsToAListOfTexts) {
  EdgeOptions options;
  ASSERT_TRUE(ApplyOverride("source.camera_sandbox.expert.read=/opt/a", options).ok());
  ASSERT_TRUE(ApplyOverride("source.camera_sandbox.expert.read=\"/opt/b\"", options).ok());
  EXPECT_THAT(options.source().camera_sandbox().expert().read(),
              ::testing::ElementsAre("/opt/a", "/opt/b"));
  GroundOptions ground;
  EXPECT_THAT(ApplyOverride("renderer.isotherm=60", ground).message(),
              HasSubstr("there is no option 'isotherm'"));
}

TEST(OverrideTest, AMisspeltExpertOptionIsFoundWhereItStands) {
  GroundOptions options;
  EXPECT_THAT(ApplyOverride("tsdf.max_wieght=3", options).message(),
              HasSubstr("Did you mean 'expert.max_weight'?"));
  EXPECT_THAT(ApplyOverride("thermal.hole_pxx=3", options).message(),
              HasSubstr("Did you mean 'expert.occlusion.hole_px'?"));
}

TEST(RenamedOptionsTest, WhatBelongsToACameraIsSaidToBeInTheRigFile) {
  GroundOptions options;
  EXPECT_THAT(ApplyOverride("thermal.near_range_m=0.2", options).message(),
              HasSubstr("It belongs to the camera: 'depth_sensor.near_range_m' of the rig file."));
}

}  // namespace
}  // namespace isotherm
