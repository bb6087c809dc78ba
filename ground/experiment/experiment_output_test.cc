#include "ground/experiment/experiment_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr Experiment kExperiment = {"sample", "fig. 1", "It shows something.", nullptr};

ExperimentReport SampleReport() {
  ExperimentReport report;
  report.table = {"method", {"points", "wrong, of all [%]"}, {{"none", {1200.0, 3.25}}}};
  report.table.rows.push_back({"the \"best\"", {1200.0, std::nan("")}});
  report.requirements = {{"wrong", 0.05, Requirement::Sense::kAtMost, 0.1, "%"}};
  report.requirements.push_back(
      NegativeControl(report.requirements.front(), "wrong without it", 3.25));
  report.renderings = {{"none", RgbImage(4, 3, Rgb8{1, 2, 3})}};
  return report;
}

TEST(RequirementTest, LimitsBelongToWhatIsAllowedAndNaNNever) {
  const auto is_met = [](double measured, Requirement::Sense sense) {
    return Requirement{"x", measured, sense, 2.0, ""}.IsMet();
  };
  EXPECT_TRUE(is_met(2.0, Requirement::Sense::kAtMost));
  EXPECT_TRUE(is_met(2.0, Requirement::Sense::kAtLeast));
  EXPECT_FALSE(is_met(2.1, Requirement::Sense::kAtMost));
  EXPECT_FALSE(is_met(1.9, Requirement::Sense::kAtLeast));
  EXPECT_FALSE(is_met(std::nan(""), Requirement::Sense::kAtMost));
  EXPECT_FALSE(is_met(std::nan(""), Requirement::Sense::kAtLeast));
}

TEST(RequirementTest, ANegativeControlMustMissTheLimit) {
  const auto is_met = [](double measured, Requirement::Sense sense) {
    return NegativeControl({"x", 0.0, sense, 2.0, ""}, "control", measured).IsMet();
  };
  EXPECT_TRUE(is_met(2.1, Requirement::Sense::kAtMost));
  EXPECT_TRUE(is_met(1.9, Requirement::Sense::kAtLeast));
  EXPECT_FALSE(is_met(2.0, Requirement::Sense::kAtMost));
  EXPECT_FALSE(is_met(2.0, Requirement::Sense::kAtLeast));
  EXPECT_FALSE(is_met(std::nan(""), Requirement::Sense::kAtMost)) << "not run is not failed";
  EXPECT_FALSE(is_met(std::nan(""), Requirement::Sense::kAtLeast));
}

TEST(ExperimentReportTest, IsMetOnlyIfItsNegativeControlWasRunAndMissesTheLimit) {
  ExperimentReport report = SampleReport();
  EXPECT_TRUE(report.AllMet());
  report.requirements.back().measured = 0.05;
  EXPECT_FALSE(report.AllMet());
  report.requirements.pop_back();
  EXPECT_FALSE(report.AllMet());
  EXPECT_THAT(ToText(kExperiment, report), HasSubstr("NOT MET  there is no negative control"));
}

TEST(ExperimentsTest, HaveDifferentNamesAndAreFoundByThem) {
  for (const Experiment& experiment : AllExperiments())
    EXPECT_EQ(FindExperiment(experiment.name), &experiment);
  EXPECT_EQ(FindExperiment("no such experiment"), nullptr);
}

TEST(ExperimentOutputTest, TextSaysWhatIsRequiredAndWhatWasMeasured) {
  ExperimentReport report = SampleReport();
  EXPECT_THAT(ToText(kExperiment, report),
              HasSubstr("met      wrong: required <= 0.1 %, measured 0.05 %"));
  EXPECT_THAT(ToText(kExperiment, report),
              HasSubstr("met      wrong without it: must miss <= 0.1 %, measured 3.25 %"));
  report.requirements.front().measured = 0.2;
  EXPECT_FALSE(report.AllMet());
  EXPECT_THAT(ToText(kExperiment, report), HasSubstr("NOT MET  wrong: required <= 0.1 %"));
}

TEST(ExperimentOutputTest, CsvQuotesWhatNeedsItAndLeavesNaNEmpty) {
  EXPECT_EQ(ToCsv(SampleReport().table),
            "method,points,\"wrong, of all [%]\"\nnone,1200,3.25\n\"the \"\"best\"\"\",1200,\n");
}

TEST(ExperimentOutputTest, WritesTableRequirementsAndRenderings) {
  const testing::TemporaryDirectory directory;
  const std::filesystem::path dir = directory.path() / "new" / "folder";
  ASSERT_TRUE(WriteExperiment(kExperiment, SampleReport(), dir).ok());
  EXPECT_TRUE(std::filesystem::exists(dir / "sample.csv"));
  EXPECT_TRUE(std::filesystem::exists(dir / "sample_none.png"));
  std::ifstream file(dir / "sample.json");
  const std::string json{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(json, HasSubstr("\"all_met\": true"));
  EXPECT_THAT(json, HasSubstr("\"limit\": 0.1"));
  EXPECT_THAT(json, HasSubstr("\"role\": \"negative control\""));
  EXPECT_THAT(json, HasSubstr("null"));
}

TEST(ExperimentOutputTest, AFolderThatCannotBeCreatedIsNamed) {
  const Status status = WriteExperiment(kExperiment, SampleReport(), "/dev/null/folder");
  EXPECT_EQ(status.code(), StatusCode::kIoError);
  EXPECT_THAT(status.message(), HasSubstr("/dev/null/folder"));
}

}  // namespace
}  // namespace isotherm
