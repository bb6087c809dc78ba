#include "ground/console/result_downloads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

class ResultDownloadsTest : public ::testing::Test {
 protected:
  ResultDownloadsTest() {
    fs::create_directories(folder() / "renders");
    Write("mesh.ply", "ply");
    Write("stats.json", "{}");
    Write("renders/thermal.png", "a rendering");
    Write("scan.mcap", "raw frames");
    Write("notes.txt", "private");
    Write("../secret.txt", "of somebody else");
    fs::create_symlink(folder() / "../secret.txt", folder() / "cloud.ply");
    scan_.set_name("scan");
    scan_.set_folder(folder().string());
    scan_.set_phase(live::Scan::ENDED);
  }
  fs::path folder() const { return directory_.path() / "scan"; }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder() / name) << text;
  }
  WebReply Get(const std::string& path, const std::string& method = "GET") const {
    WebRequest request;
    request.method = method;
    request.path = path;
    return downloads_.Answer(request, scan_);
  }
  std::vector<std::string> Listed() const {
    std::vector<std::string> names;
    const auto list = nlohmann::json::parse(*Get("/api/files").body);
    for (const auto& file : list["files"]) names.push_back(file["name"]);
    return names;
  }

  testing::TemporaryDirectory directory_;
  live::Scan scan_;
  ResultDownloads downloads_;
};

TEST_F(ResultDownloadsTest, ListsTheResultsAndNothingElse) {
  EXPECT_THAT(Listed(), ::testing::ElementsAre("mesh.ply", "renders/thermal.png", "stats.json"));
  const auto list = nlohmann::json::parse(*Get("/api/files").body);
  EXPECT_EQ(list["files"][0]["bytes"], 3);
}

TEST_F(ResultDownloadsTest, SendsWhatIsListed) {
  const WebReply mesh = Get("/api/files/mesh.ply");
  EXPECT_EQ(mesh.status, 200);
  EXPECT_EQ(mesh.file, folder() / "mesh.ply");
  const WebReply rendering = Get("/api/files/renders/thermal.png");
  EXPECT_EQ(rendering.file, folder() / "renders/thermal.png");
  EXPECT_THAT(rendering.headers,
              ::testing::Contains(std::pair<std::string, std::string>(
                  "Content-Disposition", "attachment; filename=\"thermal.png\"")));
}

TEST_F(ResultDownloadsTest, SendsNothingElse) {
  for (const char* path : {"/api/files/notes.txt", "/api/files/scan.mcap", "/api/files/cloud.ply",
                           "/api/files/../secret.txt", "/api/files/..%2fsecret.txt",
                           "/api/files//etc/passwd", "/api/files/renders/../mesh.ply",
                           "/api/files/", "/api/files/mesh.ply/", "/api/files/model.iso"}) {
    const WebReply reply = Get(path);
    EXPECT_EQ(reply.status, 404) << path;
    EXPECT_TRUE(reply.file.empty()) << path;
  }
  EXPECT_EQ(Get("/api/files/mesh.ply", "POST").status, 405);
}

TEST_F(ResultDownloadsTest, WhileAScanGoesOnOlderResultsDoNotPassForItsOwn) {
  for (const live::Scan::Phase phase : {live::Scan::WAITING, live::Scan::RUNNING}) {
    scan_.set_phase(phase);
    EXPECT_TRUE(Listed().empty());
    EXPECT_EQ(Get("/api/files/mesh.ply").status, 404);
  }
  scan_.set_phase(live::Scan::FINISHED);
  EXPECT_EQ(Get("/api/files/mesh.ply").status, 200);
  scan_.set_folder("");
  EXPECT_EQ(Get("/api/files/mesh.ply").status, 404);
  scan_ = {};
  EXPECT_EQ(Get("/api/files/mesh.ply").status, 404) << "there is no scan";
}

}  // namespace
}  // namespace isotherm
