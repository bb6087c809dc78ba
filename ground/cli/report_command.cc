#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "common/base/child_process.h"
#include "common/base/output_file.h"
#include "common/base/read_file.h"
#include "common/security/sha256.h"
#include "ground/cli/command.h"
#include "ground/cli/configuration_arguments.h"
#include "ground/cli/interpretation_arguments.h"
#include "ground/cli/model_renderings.h"
#include "ground/cli/simulation_files.h"
#include "ground/interpretation/interpretation.h"
#include "ground/measuring/shape_measurer.h"
#include "ground/measuring/shape_store.h"
#include "ground/model/load_model.h"
#include "ground/renderer/viewpoint.h"
#include "ground/report/report.h"
#include "ground/results/result_folder.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReportFooter =
    R"(Writes what was measured on a scan for those who were not there: views, the objects of shapes.json with their parameters,
an assessment by a table of severities, coverage and what was not measured and why, cameras and calibration, hashes of the
files. FILE.pdf is printed by Chromium; without it, or with FILE.html, the page itself is written. FILE.csv and FILE.json
beside it have the table and all numbers. The structure follows ISO 18434-1; no conformity is claimed.

Examples:
  isotherm report out/scan -o report.pdf
  isotherm report out/scan -o report.pdf --place "Kiln 3, door" --inspector "A. Miller, level 2" --load "full"
  isotherm report out/scan -o report.html --severity my-table.textproto --emissivity 0.95 --reflected 24)";

struct ReportArguments {
  std::string scan, output, shapes, severity, title, place, inspector, load, remarks;
  InterpretationArguments interpretation;
  ConfigurationArguments configuration;
};

/// Renders to files in a folder that goes again, and reads them back.
Result<std::vector<ReportImage>> RenderViews(const LoadedModel& model, const GroundOptions& options,
                                             const Interpretation* interpretation,
                                             const fs::path& folder, ThreadPool& pool) {
  const ModelSurface surface = SurfaceOf(model, options, interpretation, pool);
  if (surface.points_m.empty()) return std::vector<ReportImage>();
  constexpr int kWidth = 960, kHeight = 720;
  constexpr double kFov_deg = 45.0, kAside_deg = 35.0;
  RenderingRequest request;
  request.camera = RenderingCamera(kWidth, kHeight, kFov_deg);
  request.layers = {RenderLayer::kThermal, RenderLayer::kCoverage};
  const ModelAspect aspect = AspectOf(surface.points_m, model.known_poses);
  for (const double angle_deg : {0.0, kAside_deg, -kAside_deg}) {
    const Eigen::Vector3d to_viewer =
        Eigen::AngleAxisd(angle_deg * M_PI / 180.0, aspect.up_world) * aspect.to_viewer_world;
    request.views.push_back(FrameAll(surface.points_m, to_viewer, aspect.up_world, request.camera));
  }
  request.output = folder;
  request.interpretation = interpretation;
  const auto scale = ChooseScale(options.renderer(), surface.celsius);
  const auto written = WriteRenderings(model, options, scale, request, pool, [](double) {});
  if (!written) return Err(written.error());
  std::vector<ReportImage> images;
  const std::vector<fs::path> files = RenderingFiles(request);
  constexpr const char* kTitles[] = {"Temperature, from in front",  "Coverage, from in front",
                                     "Temperature, from the left",  "Coverage, from the left",
                                     "Temperature, from the right", "Coverage, from the right"};
  for (std::size_t i = 0; i < files.size() && i < std::size(kTitles); ++i) {
    constexpr std::uint64_t kMaxBytes = 64U << 20;
    Result<std::string> png = ReadFile(files[i], kMaxBytes);
    if (!png) return Err(png.error());
    images.push_back({kTitles[i], std::move(*png)});
  }
  return images;
}

std::string TimeOf(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  if (error) return "";
  const auto system = std::chrono::file_clock::to_sys(written);
  const std::time_t seconds = std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(system));
  return fmt::format("{:%Y-%m-%d %H:%M} UTC (end)", fmt::gmtime(seconds));
}

std::vector<std::pair<std::string, std::string>> HashesOf(const fs::path& folder,
                                                          const fs::path& model) {
  std::vector<std::pair<std::string, std::string>> hashes;
  for (const fs::path& path :
       {model, folder / "scan.mcap", folder / "stats.json", folder / kShapesName}) {
    if (const auto hash = Sha256OfFile(path)) hashes.emplace_back(path.filename(), *hash);
  }
  return hashes;
}

std::optional<fs::path> FindBrowser() {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const fs::path candidate = fs::path(rest.substr(0, colon)) / name;
      if (access(candidate.c_str(), X_OK) == 0) return candidate;
    }
    if (colon == std::string_view::npos) break;
    rest.remove_prefix(colon + 1);
  }
  return std::nullopt;
}

/// A folder of its own that goes with this object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = fs::temp_directory_path() / "isotherm-report-XXXXXX";
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code error;
    if (!path_.empty()) fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Has a browser print a page. Nothing is loaded from anywhere.
Status Print(const fs::path& browser, const fs::path& html, const fs::path& pdf,
             const fs::path& scratch) {
  constexpr auto kPatience = std::chrono::seconds(60);
  std::vector<std::string> arguments = {"--headless",
                                        "--disable-gpu",
                                        "--no-first-run",
                                        "--disable-background-networking",
                                        "--disable-component-update",
                                        "--disable-sync",
                                        "--no-pdf-header-footer",
                                        "--user-data-dir=" + (scratch / "profile").string(),
                                        "--print-to-pdf=" + fs::absolute(pdf).string(),
                                        "file://" + html.string()};
  if (geteuid() == 0) arguments.insert(arguments.begin(), "--no-sandbox");
  auto child = ChildProcess::Start(browser, arguments, scratch / "browser.log");
  if (!child) return child.error();
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (const std::optional<int> status = child->Poll()) {
      std::error_code error;
      if (*status == 0 && fs::exists(pdf, error)) return OkStatus();
      return Unavailable(fmt::format("{} ended with exit status {}: {}", browser.string(), *status,
                                     LastLines(child->log(), 3)));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return Unavailable(browser.string() + " did not print within a minute");
}

Result<ReportInputs> Gather(const ReportArguments& arguments, const fs::path& path,
                            GroundOptions options, const fs::path& scratch) {
  const Result<LoadedModel> model = LoadModel(path, options);
  if (!model) return Err(model.error());
  const fs::path folder = path.parent_path();
  ReportInputs inputs;
  inputs.title = !arguments.title.empty()
                     ? arguments.title
                     : fs::absolute(folder).lexically_normal().filename().string();
  inputs.place = arguments.place;
  inputs.inspector = arguments.inspector;
  inputs.load = arguments.load;
  inputs.remarks = arguments.remarks;
  inputs.when = TimeOf(path);
  inputs.software = SoftwareName();
  inputs.rig = model->rig;
  inputs.limits = CompleteLimits(options.thermal(), model->rig.thermal_sensor);
  inputs.interpretation = options.interpretation();
  inputs.hashes = HashesOf(folder, path);
  if (!arguments.severity.empty()) {
    auto severity = ReadSeverityTables(arguments.severity);
    if (!severity) return Err(severity.error());
    inputs.severity = std::move(*severity);
  }
  const auto shapes =
      ReadShapes(arguments.shapes.empty() ? folder / kShapesName : fs::path(arguments.shapes));
  if (!shapes && (!arguments.shapes.empty() || shapes.error().code() != StatusCode::kNotFound))
    return Err(shapes.error());
  ThreadPool pool(ChosenThreads(options.threads()));
  if (shapes) {
    ShapeMeasurer measurer(*model->tsdf, *model->thermal, RigidTransform::Identity(),
                           MakeMeasuringOptions(options, model->rig.thermal_sensor));
    *inputs.measurements.mutable_shapes() = shapes->shapes();
    for (measuring::MeasuredShape& measured : measurer.Measure(*shapes))
      *inputs.measurements.add_measured() = std::move(measured);
  }
  inputs.coverage = CoverageOf(ExtractSurface(
      *model->tsdf, *model->thermal,
      {.min_weight = static_cast<float>(options.export_().expert().min_weight())}, pool));
  const auto interpretation = Interpretation::Create(options.interpretation());
  if (!interpretation) return Err(interpretation.error());
  auto images =
      RenderViews(*model, options, interpretation->changes_nothing() ? nullptr : &*interpretation,
                  scratch, pool);
  if (!images) return Err(images.error());
  inputs.images = std::move(*images);
  return inputs;
}

Status Write(const ReportFiles& files, const fs::path& output, const fs::path& scratch) {
  fs::path beside = output;
  ISOTHERM_RETURN_IF_ERROR(WriteFile(beside.replace_extension(".csv"), files.csv));
  ISOTHERM_RETURN_IF_ERROR(WriteFile(beside.replace_extension(".json"), files.json));
  fs::path page = output;
  page.replace_extension(".html");
  const std::optional<fs::path> browser = FindBrowser();
  if (output.extension() != ".pdf" || !browser) {
    ISOTHERM_RETURN_IF_ERROR(WriteFile(page, files.html));
    if (output.extension() == ".pdf")
      fmt::print(stderr, "There is no Chromium to print with: {} can be printed by any browser.\n",
                 page.string());
    fmt::print("{}\n", page.string());
    return OkStatus();
  }
  const fs::path html = scratch / "report.html";
  ISOTHERM_RETURN_IF_ERROR(WriteFile(html, files.html));
  ISOTHERM_RETURN_IF_ERROR(Print(*browser, html, output, scratch));
  fmt::print("{}\n", output.string());
  return OkStatus();
}

int Run(const ReportArguments& arguments) {
  const auto path = FindModel(arguments.scan);
  if (!path) return Fail(path.error());
  GroundOptions options = ConfigurationOf(path->parent_path()).value_or(GroundOptions());
  Problems problems;
  Apply(arguments.configuration, options, problems);
  problems.Add(ApplyArguments(arguments.interpretation, *options.mutable_interpretation()));
  if (!problems.empty()) return FailConfiguration(problems.text());
  const ScratchFolder scratch;
  if (scratch.path().empty()) return Fail(IoError("no folder for temporary files can be made"));
  const Result<ReportInputs> inputs = Gather(arguments, *path, options, scratch.path());
  if (!inputs) return Fail(inputs.error());
  const Status written = Write(MakeReport(*inputs), arguments.output, scratch.path());
  return written.ok() ? 0 : Fail(written);
}

}  // namespace

void AddReportCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("report", "Writes a report on a finished scan as PDF");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("scan", arguments->scan, "Result folder or model (model.iso)")->required();
  command->add_option("-o,--output", arguments->output, "FILE.pdf or FILE.html")->required();
  command->add_option("--shapes", arguments->shapes, "File with shapes instead of shapes.json");
  command->add_option("--severity", arguments->severity,
                      "Table of severities (deploy/severity/neta-mts.textproto is an example)");
  command->add_option("--title", arguments->title, "Title; the folder's name if none is given");
  command->add_option("--place", arguments->place, "What was scanned, and where");
  command->add_option("--inspector", arguments->inspector, "Thermographer and qualification");
  command->add_option("--load", arguments->load, "Load and conditions during the scan");
  command->add_option("--remarks", arguments->remarks, "Anything else");
  AddInterpretationOptions(*command, arguments->interpretation);
  AddConfigurationArguments(*command, arguments->configuration);
  command->footer(kReportFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
