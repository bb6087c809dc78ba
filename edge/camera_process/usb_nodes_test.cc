#include "edge/camera_process/usb_nodes.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

class UsbNodesTest : public ::testing::Test {
 protected:
  void Write(const std::filesystem::path& file, const std::string& text) const {
    const std::filesystem::path path = folder_.path() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  void AddDevice(const std::string& name, const std::string& vendor, const std::string& product,
                 int number) const {
    Write(name + "/idVendor", vendor);
    Write(name + "/idProduct", product);
    Write(name + "/busnum", "1");
    Write(name + "/devnum", std::to_string(number));
  }

  const testing::TemporaryDirectory folder_;
};

TEST_F(UsbNodesTest, FindsTheFilesOfEachDeviceAndWhatItIs) {
  AddDevice("1-1", "1d27", "0609", 4);
  AddDevice("1-2", "0403", "de37", 17);
  Write("1-2/1-2:1.0/video4linux/video3/name", "a camera");
  Write("1-3/idVendor", "1234");
  const std::vector<UsbNode> nodes = ListUsbNodes(folder_.path());
  ASSERT_EQ(nodes.size(), 2U) << "what is not complete is no device";
  EXPECT_EQ(nodes[0].vendor_id, 0x1d27);
  EXPECT_EQ(nodes[0].product_id, 0x0609);
  EXPECT_EQ(nodes[0].paths, std::vector<std::string>{"/dev/bus/usb/001/004"});
  EXPECT_EQ(nodes[1].paths, (std::vector<std::string>{"/dev/bus/usb/001/017", "/dev/video3"}));
}

TEST_F(UsbNodesTest, WithoutUsbThereIsNothing) {
  EXPECT_TRUE(ListUsbNodes(folder_.path() / "missing").empty());
}

}  // namespace
}  // namespace isotherm
