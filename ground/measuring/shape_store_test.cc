#include "ground/measuring/shape_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryDirectory;

measuring::Shape Spot(const std::string& id, const std::string& name = "") {
  measuring::Shape shape;
  shape.set_id(id);
  shape.set_name(name);
  shape.set_kind(measuring::Shape::SPOT);
  measuring::Anchor& anchor = *shape.add_anchors();
  anchor.mutable_origin()->set_x(0.1);
  anchor.mutable_direction()->set_z(1.0 / 3.0);
  return shape;
}

TEST(ShapeStoreTest, ShapesAreAddedRenamedAndRemoved) {
  ShapeStore store;
  ASSERT_TRUE(store.Put(Spot("a")).ok());
  ASSERT_TRUE(store.Put(Spot("b")).ok());
  ASSERT_TRUE(store.Put(Spot("a", "door")).ok());
  ASSERT_EQ(store.shapes().shapes_size(), 2);
  EXPECT_EQ(store.shapes().shapes(0).name(), "door");
  ASSERT_TRUE(store.Remove("a").ok());
  ASSERT_EQ(store.shapes().shapes_size(), 1);
  EXPECT_EQ(store.shapes().shapes(0).id(), "b");
  EXPECT_EQ(store.Remove("a").code(), StatusCode::kNotFound);
}

TEST(ShapeStoreTest, EachChangeCanBeTakenBack) {
  ShapeStore store;
  ASSERT_TRUE(store.Put(Spot("a")).ok());
  ASSERT_TRUE(store.Put(Spot("a", "door")).ok());
  ASSERT_TRUE(store.Clear().ok());
  EXPECT_EQ(store.undoable(), 3U);
  ASSERT_TRUE(store.Undo().ok());
  EXPECT_EQ(store.shapes().shapes(0).name(), "door");
  ASSERT_TRUE(store.Undo().ok());
  EXPECT_EQ(store.shapes().shapes(0).name(), "");
  ASSERT_TRUE(store.Undo().ok());
  EXPECT_EQ(store.shapes().shapes_size(), 0);
  EXPECT_EQ(store.Undo().code(), StatusCode::kFailedPrecondition);
}

TEST(ShapeStoreTest, WhatIsRefusedChangesNothing) {
  ShapeStore store;
  measuring::Shape broken = Spot("a");
  broken.clear_anchors();
  EXPECT_FALSE(store.Put(broken).ok());
  EXPECT_EQ(store.shapes().shapes_size(), 0);
  EXPECT_EQ(store.undoable(), 0U);
}

TEST(ShapeStoreTest, TheListHasAnEnd) {
  ShapeStore store;
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(store.Put(Spot(std::to_string(i))).ok());
  EXPECT_EQ(store.Put(Spot("more")).code(), StatusCode::kResourceExhausted);
  EXPECT_TRUE(store.Put(Spot("7", "renamed")).ok());
}

TEST(ShapeStoreTest, AFileReadsBackExactly) {
  const TemporaryDirectory folder;
  const auto path = folder.path() / kShapesName;
  ShapeStore store;
  ASSERT_TRUE(store.Put(Spot("a", "Tür \"1\"")).ok());
  ASSERT_TRUE(WriteShapes(path, store.shapes()).ok());
  const auto read = ReadShapes(path);
  ASSERT_TRUE(read);
  EXPECT_EQ(ExactJson(*read), ExactJson(store.shapes()));
  EXPECT_EQ(read->shapes(0).anchors(0).direction().z(), 1.0 / 3.0);
}

TEST(ShapeStoreTest, BrokenFilesAreRefusedByName) {
  const TemporaryDirectory folder;
  const auto path = folder.path() / kShapesName;
  EXPECT_EQ(ReadShapes(path).error().code(), StatusCode::kNotFound);
  std::ofstream(path) << "{\"shapes\": [{\"id\": \"a\", \"kind\": \"SPOT\"}]}";
  EXPECT_THAT(ReadShapes(path).error().message(), HasSubstr("shapes.json: shape \"a\""));
  std::ofstream(path) << "{\"shapes\": [";
  EXPECT_THAT(ReadShapes(path).error().message(), HasSubstr("shapes.json"));
}

}  // namespace
}  // namespace isotherm
