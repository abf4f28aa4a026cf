// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/folder_view.h"

#include <atomic>
#include <mutex>
#include <shared_mutex>
#include <sstream>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/view/background.h"
#include "tools/view/event_bus.h"
#include "tools/view/flock_series.h"
#include "tools/view/folder_path.h"
#include "tools/view/late_reader.h"
#include "tools/view/page_routes.h"
#include "tools/view/page_text.h"
#include "tools/view/run_data.h"
#include "tools/view/sketch.h"
#include "tools/view/solve_options.h"
#include "tools/view/solver.h"
#include "tools/view/suspects.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSketch = "sketch_tracks.csv";

}  // namespace

class FolderView::Impl {
 public:
  Impl(const RunDataOptions& options, int threads)
      : data_(options),
        threads_(threads),
        told_animals_(data_.animal_count()),
        reader_(&data_, &mutex_, &bus_),
        solver_({.accepted =
                     [this](auto job) {
                       bus_.Publish("solve", {{"job", job}, {"state", "accepted"}});
                     },
                 .progress = [this](auto job, auto done, auto total) { Tell(job, done, total); },
                 .finished = [this](auto job, ReconstructResult&& result,
                                    double seconds) { Finished(job, std::move(result), seconds); },
                 .failed =
                     [this](auto job, const std::string& reason) {
                       bus_.Publish("solve", {{"job", job}, {"state", "failed"}, {"text", reason}});
                     }}) {}

  void Serve(HttpServer* server) {
    ServePage(
        server, &bus_, [this] { return FirstData(); },
        [this] { std::call_once(is_heard_, [this] { ReadOn(); }); });
    server->Get("/api/session", [this](const HttpRequest&) {
      const std::shared_lock lock(mutex_);
      return JsonReply(data_.Session());
    });
    server->Get("/api/window", [this](const HttpRequest& r) { return Window(r); });
    server->Get("/api/series", [this](const HttpRequest& r) { return Series(r); });
    server->Get("/api/suspects", [this](const HttpRequest&) { return Suspects(); });
    server->Get("/frame/", [this](const HttpRequest& r) { return Frame(r); });
    server->Get("/files/", [this](const HttpRequest& r) { return File(r); });
    server->Get("/video", [this](const HttpRequest&) -> HttpReply {
      const auto& footage = data_.footage();
      if (!footage || footage->file().empty()) return {.status = 404, .body = "{}"};
      return {.type = "video/mp4", .file = footage->file()};
    });
    server->Post("/api/solve", [this](const HttpRequest& r) { return Solve(BodyOf(r)); });
    server->Post("/api/cancel", [this](const HttpRequest&) {
      solver_.Cancel();
      bus_.Publish("solve", {{"state", "cancelled"}});
      return JsonReply(Json::object());
    });
    server->Post("/api/edit", [this](const HttpRequest& r) { return Edit(BodyOf(r)); });
    server->Post("/api/undo", [this](const HttpRequest&) {
      return Change([](TrackEditor& editor) { Check(editor.Undo(), "there is nothing to undo"); });
    });
    server->Post("/api/redo", [this](const HttpRequest&) {
      return Change([](TrackEditor& editor) { Check(editor.Redo(), "there is nothing to redo"); });
    });
    server->Post("/api/sketch", [this](const HttpRequest& r) { return Sketch(BodyOf(r)); });
  }

 private:
  // A browser that starts needs every core until it shows something: pages listen from then on.
  void ReadOn() {
    background_.Add([this](const Progress& alive) {
      reader_.Run(alive);
      RankSuspects();
    });
  }

  // All that the page's first picture needs but the film's: a browser that starts takes long to
  // ask.
  Json FirstData() {
    background_.GiveWay();
    const std::shared_lock lock(mutex_);
    const int frame = data_.Span().first;
    Json rows = Json::object();
    for (const char* what : {"boxes", data_.FlockOf("after") != nullptr ? "after" : "before"}) {
      try {
        rows[what] = AsBase64(data_.Window(what, frame, frame));
      } catch (const InputError&) {
        // the page hears of it when it asks
      }
    }
    TellAnimals();
    return {{"session", data_.Session()}, {"first", {{"frame", frame}, {"rows", rows}}}};
  }

  HttpReply Window(const HttpRequest& request) {
    background_.GiveWay();
    const int first = request.Number("first"), last = request.Number("last");
    const std::shared_lock lock(mutex_);
    HttpReply reply = BinaryReply(data_.Window(request.Text("what"), first, last));
    TellAnimals();
    return reply;
  }

  void TellAnimals() {
    const std::size_t animals = data_.animal_count();
    if (told_animals_.exchange(animals) < animals) bus_.Publish("data", data_.Versions());
  }

  HttpReply Series(const HttpRequest& request) {
    const std::shared_lock lock(mutex_);
    const TrajectoryTable& table = data_.Curves(request.Text("what", "before"));
    const std::string animal = request.Text("animal");
    if (animal.empty()) return JsonReply(FlockSeries(table, data_.run().camera));
    const int index = request.Number("animal");
    Check(index >= 0, "animals count from 0");
    return JsonReply(AnimalSeries(table, data_.run().camera, static_cast<std::uint32_t>(index)));
  }

  HttpReply Suspects() {
    const std::shared_lock lock(mutex_);
    Json list = Json::array();
    const Json& doubts = data_.TrackerDoubts();
    const std::vector<Suspect> suspects =
        doubts.is_array() ? SuspectsOfTracker(doubts, data_.Corrections()) : ranked_;
    for (const Suspect& s : suspects) {
      list.push_back({{"frame", s.frame},
                      {"id", std::to_string(s.id)},
                      {"other", s.other_id == 0 ? "" : std::to_string(s.other_id)},
                      {"what", s.what},
                      {"doubt", s.doubt}});
    }
    return JsonReply(list);
  }

  // Where the tracker left no doubts of its own, the page's are found in the background, and told.
  void RankSuspects() {
    background_.Add([this](const Progress& alive) {
      TrackList tracks;
      double width = 1e4, height = 1e4;
      {
        const std::shared_lock lock(mutex_);
        if (data_.TrackerDoubts().is_array()) return;
        tracks = data_.CurrentTracks();
        const auto& footage = data_.footage();
        const auto& camera = data_.run().camera;
        if (footage || camera) {
          width = footage ? footage->width() : camera->width;
          height = footage ? footage->height() : camera->height;
        }
      }
      std::vector<Suspect> found = FindSuspects(tracks, width, height, alive);
      {
        const std::unique_lock lock(mutex_);
        ranked_ = std::move(found);
      }
      bus_.Publish("suspects", {{"number", ++rankings_}});
    });
  }

  HttpReply Frame(const HttpRequest& request) {
    background_.GiveWay();
    const auto& footage = data_.footage();
    HttpRequest numbered = request;
    numbered.query["frame"] = request.path.substr(request.path.find_last_of('/') + 1);
    const int frame = numbered.Number("frame");
    const int width = request.query.contains("width") ? request.Number("width") : 1 << 20;
    const std::string jpeg = footage ? footage->Jpeg(frame, width) : "";
    if (jpeg.empty()) return {.status = 404, .body = R"({"error": "there is no such frame"})"};
    return {.type = "image/jpeg", .body = jpeg};
  }

  HttpReply File(const HttpRequest& request) {
    const std::string name = request.path.substr(std::string("/files/").size());
    const auto path = PathInFolder(data_.folder(), name);
    if (!path || !fs::is_regular_file(*path)) {
      return {.status = 404, .body = R"({"error": "there is no such file in the folder"})"};
    }
    HttpReply reply{.type = "application/octet-stream", .file = *path};
    if (IsPlainFileName(name, "")) reply.download_name = name;
    return reply;
  }

  HttpReply Solve(const Json& body) {
    Solver::Job job;
    std::string line;
    {
      const std::shared_lock lock(mutex_);
      const RunFolder& run = data_.run();
      Check(run.camera.has_value(), "there is no camera");
      Check(run.fps.has_value(), "nothing says how many frames a second has");
      ReconstructCommand command = data_.Command();
      TakeSolveOptions(body, &command);
      const bool of_sketch = body.value("source", "tracks") == "sketch";
      if (of_sketch) {
        command.tracks = data_.folder() / kSketch;
        command.no_size = true;
      }
      ReconstructOptions options;
      options.method =
          command.method == "cobyla" ? ReconstructMethod::kCobyla : ReconstructMethod::kBatch;
      options.knowledge = KnowledgeOf(command);
      options.pitch_deg = command.pitch_deg;
      options.batch = command.batch;
      options.cobyla = command.cobyla;
      line = CommandLineOf(command);
      job = [options, tracks = of_sketch ? Shared(sketch_) : data_.CurrentTracks(),
             camera = *run.camera, fps = *run.fps, threads = threads_](const Progress& progress) {
        return Reconstruct(options, AsTracks(tracks), camera, fps, threads, progress);
      };
    }
    const std::int64_t number = solver_.Start(std::move(job));
    return JsonReply({{"job", number}, {"command", line}});
  }

  void Tell(std::int64_t job, std::int64_t done, std::int64_t total) {
    bus_.Publish("solve", {{"job", job}, {"state", "running"}, {"done", done}, {"total", total}});
  }

  void Finished(std::int64_t job, ReconstructResult&& result, double seconds) {
    Json versions;
    {
      const std::unique_lock lock(mutex_);
      data_.SetSolved(result.trajectories);
      versions = data_.Versions();
    }
    const ReconstructReport& report = result.report;
    bus_.Publish("data", versions);
    bus_.Publish("solve", {{"job", job},
                           {"state", "done"},
                           {"seconds", seconds},
                           {"animals", result.trajectories.trajectories.size()},
                           {"iterations", report.iterations},
                           {"cost", report.final_cost},
                           {"converged", report.converged},
                           {"text", report.observability},
                           {"warnings", report.warnings}});
  }

  HttpReply Edit(const Json& body) {
    std::istringstream line(body.at("line").get<std::string>() + "\n");
    const std::vector<Correction> corrections = ReadCorrections(line, "the correction");
    Check(corrections.size() == 1, "send one correction");
    return Change([&](TrackEditor& editor) { editor.Apply(corrections.front()); });
  }

  template <typename Work>
  HttpReply Change(const Work& work) {
    Json edits, versions;
    {
      const std::unique_lock lock(mutex_);
      work(data_.editor());
      data_.TracksChanged();
      edits = data_.Edits();
      versions = data_.Versions();
    }
    RankSuspects();
    bus_.Publish("edits", edits);
    bus_.Publish("data", versions);
    return JsonReply({{"edits", edits}, {"versions", versions}});
  }

  HttpReply Sketch(const Json& body) {
    const std::vector<Stroke> strokes = StrokesOf(body);
    const std::unique_lock lock(mutex_);
    constexpr double kSize = 12;  // [px]; the size is not used
    sketch_ = TracksOfStrokes(strokes, kSize);
    sketch_.fps = data_.run().fps;
    WriteTracks(data_.folder() / kSketch, sketch_);
    return JsonReply(
        {{"file", (data_.folder() / kSketch).string()}, {"tracks", sketch_.tracklets.size()}});
  }

  std::shared_mutex mutex_;  // guards data_, sketch_ and ranked_
  RunData data_;
  Tracks sketch_;
  std::vector<Suspect> ranked_;
  int threads_, rankings_ = 0;
  std::atomic<std::size_t> told_animals_;
  EventBus bus_;
  LateReader reader_;
  std::once_flag is_heard_;
  Solver solver_;  // these are the last, so that they stop before what they tell goes
  Background background_;
};

FolderView::FolderView(const RunDataOptions& options, int threads)
    : impl_(std::make_unique<Impl>(options, threads)) {}
FolderView::~FolderView() = default;
void FolderView::Serve(HttpServer* server) { impl_->Serve(server); }

}  // namespace flocklift
