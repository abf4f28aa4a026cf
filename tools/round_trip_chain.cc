// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/round_trip_chain.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/load_scene.h"
#include "simulate/flock/population.h"
#include "simulate/render/film.h"
#include "simulate/synthetic.h"
#include "tools/evaluate_files.h"
#include "tools/replay_command.h"
#include "tools/scene_scenery.h"
#include "tools/stage.h"
#include "tools/summary_options.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::optional<fs::path> CsvOrHdf5(const fs::path& folder, const std::string& stem) {
  for (const char* extension : {".csv", ".h5"}) {
    const fs::path path = folder / (stem + extension);
    if (fs::is_regular_file(path)) return path;
  }
  return std::nullopt;
}

// The scene that the truth was made of, unchanged since; nothing where it is not to be found.
std::optional<fs::path> FindScene(const fs::path& truth, const Json& summary) {
  const std::vector<fs::path> inputs = InputsOf(summary);
  if (inputs.empty()) return std::nullopt;
  const std::string sha256 = summary.at("inputs").front().value("sha256", "");
  for (const fs::path& path : {inputs.front(), truth / inputs.front().filename(),
                               truth.parent_path() / inputs.front().filename()}) {
    if (fs::is_regular_file(path) && Sha256OfFile(path) == sha256) return path;
  }
  return std::nullopt;
}

template <typename T>
void Take(const Json& json, const char* name, T* value) {
  const auto found = json.find(name);
  if (found != json.end()) found->get_to(*value);
}

// Of those rows that the tracks have too, positions alone.
Trajectories PositionsInView(const Trajectories& truth, const Tracks& tracks) {
  std::map<Id, std::set<int>> frames;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& seen : tracklet.detections) frames[tracklet.id].insert(seen.frame);
  }
  Trajectories seen = truth;
  for (Trajectory& path : seen.trajectories) {
    const std::set<int>& there = frames[path.id];
    std::erase_if(path.points, [&](const TrajectoryPoint& p) { return !there.contains(p.frame); });
  }
  std::erase_if(seen.trajectories, [](const Trajectory& path) { return path.points.empty(); });
  seen.has_velocity = seen.has_orientation = seen.has_sd_depth = false;
  return seen;
}

// In the surroundings of the scene.
void Film(const RoundTripChain& chain, const fs::path& path, const Trajectories& flock,
          const std::vector<Animal>& animals, const RenderSpec& look, const FilmOptions& options,
          const Progress& progress) {
  const std::vector<Obstacle> solid = LoadObstacles(chain.scene);
  const Scenery scenery = SceneScenery(chain.scene, solid);
  FilmOptions complete = options;
  complete.fps = chain.fps;
  complete.seed = chain.scene.seed;
  complete.scenery = &scenery;
  FilmTrajectories(path, flock, animals, chain.camera, look, complete, progress);
}

class Chain {
 public:
  Chain(const fs::path& folder, const CommonOptions& common)
      : truth_(folder / "truth"),
        result_(folder / "result"),
        out_(folder / "round_trip"),
        common_(common) {
    common_.reuse = true;
    common_.json = false;
  }

  RoundTripChain Run() {
    if (!FindParts() || !ReadTruth()) return std::move(chain_);
    AddLeg(tracks_of_film_ ? "film" : "track", result_, /*has_true_ids=*/false);
    if (tracks_of_film_) FromTracking();
    FromReconstruction();
    FromFit();
    FromStart();
    return std::move(chain_);
  }

 private:
  void Miss(const std::string& what) { chain_.missing.push_back(what); }

  // Everything that the folder must hold, and a line for what it does not.
  bool FindParts() {
    const auto need = [&](bool there, const std::string& what, const std::string& command) {
      if (!there) Miss("no " + what + ": flocklift " + command);
      return there;
    };
    const std::string truth = truth_.string(), result = result_.string();
    const std::string camera = " --camera " + truth + "/camera.yaml";
    simulate_ = SummaryIn(truth_, "simulate");
    reconstruct_ = SummaryIn(result_, "reconstruct");
    fit_ = SummaryIn(result_, "fit");
    track_ = SummaryIn(result_, "track");
    const auto paths = CsvOrHdf5(truth_, "trajectories");
    const auto seen = CsvOrHdf5(result_, "trajectories");
    bool all = need(paths && !simulate_.is_null() && fs::exists(truth_ / "camera.yaml"), "truth",
                    "simulate SCENE --out " + truth);
    all &= need(CsvOrHdf5(result_, "tracks").has_value(), "tracks",
                "track " + truth + "/video.mp4 --out " + result);
    all &= need(seen && !reconstruct_.is_null(), "reconstruction",
                "reconstruct " + result + "/tracks.csv" + camera +
                    " --wingspan MEAN,SD --speed MEAN,SD --out " + result);
    const bool flies = !fit_.is_null() &&
                       fit_.value("options", Json::object()).value("model", "") != kKernelsModel;
    all &= need(fs::exists(result_ / "parameters.toml") && flies, "fit",
                "fit " + result + "/trajectories.csv" + camera + " --out " + result);
    if (!all) return false;
    const Json replay = SummaryIn(result_ / "replay", "replay");
    if (need(!replay.is_null(), "replay (it is flown with the defaults)",
             "replay " + result + "/trajectories.csv --parameters " + result + "/parameters.toml" +
                 camera + " --out " + result + "/replay")) {
      TakeOptions(replay.at("options"), &chain_.replay);
      Take(replay.at("options"), "wingspan", &chain_.wingspan);
    }
    chain_.replay.count = 0;  // the animals that there were, free
    chain_.replay.alpha = 1;
    true_file_ = *paths;
    result_file_ = *seen;
    return true;
  }

  bool ReadTruth() {
    const auto scene = FindScene(truth_, simulate_);
    if (!scene) {
      Miss("the scene of " + truth_.string() +
           " is not there or has changed since: flocklift "
           "simulate SCENE --out " +
           truth_.string());
      return false;
    }
    chain_.scene = ReadScene(*scene);
    const Json& options = simulate_.at("options");
    Take(options, "seed", &chain_.scene.seed);
    Take(options, "fps", &chain_.scene.fps);
    Take(options, "duration", &chain_.scene.duration);
    if (chain_.scene.species.size() != 1) {
      Miss("the scene has several species, a fit and its replay know one");
      return false;
    }
    for (const fs::path& input : InputsOf(reconstruct_)) {
      const std::string name = input.stem().string();
      if (input.extension() != ".yaml" && !name.starts_with("tracks") && name != "shapes") {
        Miss("the reconstruction used " + input.string() +
             ", which names animals of its own film: "
             "it cannot be done again from true tracks");
        return false;
      }
    }
    chain_.truth = ReadTrajectories(true_file_);
    chain_.camera = ReadCamera(truth_ / "camera.yaml");
    chain_.fps = chain_.scene.fps;
    animals_ = Populate(chain_.scene).animals;
    chain_.inputs = {true_file_, truth_ / "camera.yaml", *scene, result_file_,
                     result_ / "parameters.toml"};
    const std::vector<fs::path> filmed = InputsOf(track_);
    tracks_of_film_ = filmed.size() == 1 && filmed.front().filename() == "video.mp4";
    if (!tracks_of_film_) {
      Miss("the film's share is in that of tracking: the tracks are not of the film alone");
    }
    return true;
  }

  void AddLeg(const std::string& stage, const fs::path& folder, bool has_true_ids) {
    RoundTripLeg leg;
    leg.stage = stage;
    leg.paths = ReadTrajectories(*CsvOrHdf5(folder, "trajectories"));
    if (!leg.paths.has_velocity) ComputeVelocities(chain_.fps, &leg.paths);
    leg.parameters = ReadParameters(folder / "parameters.toml");
    leg.has_true_ids = has_true_ids;
    chain_.legs.push_back(std::move(leg));
  }

  CommonOptions Inside(const char* leg) const {
    CommonOptions inside = common_;
    inside.out = out_ / leg;
    return inside;
  }

  void Reconstruct(const CommonOptions& common) const {
    ReconstructCommand command = ReconstructCommandOf(reconstruct_);
    command.tracks = common.out / "tracks.csv";
    command.camera = truth_ / "camera.yaml";
    RunReconstruct(command, common);
  }

  void Fit(const CommonOptions& common) const {
    FitCommand command = FitCommandOf(fit_, ScaleSdOfSummary(result_));
    command.trajectories = common.out / "trajectories.csv";
    command.camera = truth_ / "camera.yaml";
    CommonOptions as_before = common;
    Take(fit_.at("options"), "seed", &as_before.seed);
    RunFit(command, as_before);
  }

  // The truth filmed as clearly as can be, then as the chain went.
  void FromTracking() {
    const CommonOptions common = Inside("track");
    Stage film("film", common);
    film.AddInput(true_file_);
    film.AddInput(truth_ / "camera.yaml");
    film.AddInput(chain_.inputs[2]);
    film.AddOutput("video.mp4");
    if (!film.IsUpToDate()) {
      RenderSpec clear = chain_.scene.render;
      clear.background = "plain";
      clear.noise = clear.blur = clear.haze = 0;
      FilmOptions options{.frames = chain_.scene.FrameCount(), .threads = common.ThreadCount()};
      TakeOptions(simulate_.at("options"), &options.video);
      options.video.crf = 1;
      const Progress progress = film.BeginPhase("film");
      Film(chain_, common.out / "video.mp4", chain_.truth, animals_, clear, options, progress);
      film.Finish();
    }
    TrackCommand track = TrackCommandOf(track_);
    track.video = common.out / "video.mp4";
    RunTrack(track, common);
    Reconstruct(common);
    Fit(common);
    AddLeg("track", common.out, /*has_true_ids=*/false);
  }

  void FromReconstruction() {
    const CommonOptions common = Inside("reconstruct");
    true_tracks_ =
        SynthesizeTracks(chain_.truth, animals_, chain_.camera, chain_.fps, common.ThreadCount());
    WriteTracks(common.out / "tracks.csv", true_tracks_);
    WriteShapes(common.out / "shapes.csv", true_tracks_);
    Reconstruct(common);
    Fit(common);
    AddLeg("reconstruct", common.out, /*has_true_ids=*/true);
  }

  void FromFit() {
    const CommonOptions common = Inside("fit");
    Trajectories seen = PositionsInView(chain_.truth, true_tracks_);
    seen.fps = chain_.fps;
    WriteTrajectories(common.out / "trajectories.csv", seen);
    Fit(common);
    AddLeg("fit", common.out, /*has_true_ids=*/true);
  }

  // The true parameters, then the true velocities and the animals out of view too.
  void FromStart() {
    RoundTripLeg leg = chain_.legs.back();
    leg.stage = "start";
    leg.parameters = {};
    leg.parameters.model = chain_.scene.species.front().model;
    leg.parameters.model.terms = chain_.scene.species.front().forces;
    leg.parameters.walls = chain_.scene.box;
    for (const GoalSpec& goal : chain_.scene.goals) {
      if (goal.species.empty() || goal.species == chain_.scene.species.front().name) {
        leg.parameters.goals.push_back(goal);
      }
    }
    chain_.legs.push_back(leg);
    leg.stage = "replay";
    leg.paths = chain_.truth;
    if (!leg.paths.has_velocity) ComputeVelocities(chain_.fps, &leg.paths);
    chain_.legs.push_back(std::move(leg));
  }

  fs::path truth_, result_, out_;
  CommonOptions common_;
  Json simulate_, track_, reconstruct_, fit_;
  fs::path true_file_, result_file_;
  std::vector<Animal> animals_;
  Tracks true_tracks_;
  bool tracks_of_film_ = false;
  RoundTripChain chain_;
};

}  // namespace

RoundTripChain RunRoundTripChain(const fs::path& folder, const CommonOptions& common) {
  return Chain(folder, common).Run();
}

FilmAgain MakeFilmAgain(const RoundTripChain& chain, const fs::path& folder,
                        const CommonOptions& common) {
  const Json track = SummaryIn(folder / "result", "track");
  if (track.is_null()) return {};
  return [&chain, &common, folder,
          options = TrackCommandOf(track).tracker](const Trajectories& flock) {
    const fs::path video = folder / "round_trip" / "film_again" / "video.mp4";
    Film(chain, video, flock, BodiesOf(flock, chain.wingspan, chain.scene.seed), chain.scene.render,
         {.threads = common.ThreadCount()}, {});
    return TrackVideo(options, video, {}, chain.fps).tracks;
  };
}

}  // namespace flocklift
