// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/track_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/stage.h"
#include "tools/track_from.h"
#include "tools/track_overlay.h"
#include "tools/track_picture.h"
#include "track/correct.h"
#include "track/density_flow.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

void SetFigures(const TrackerReport& report, const Tracks& tracks, Stage* stage) {
  const TrackerTimings& t = report.timings;
  nlohmann::ordered_json figures = {
      {"frames_per_second",
       static_cast<double>(report.frames - report.frames_before) / std::max(t.total_s, 1e-9)},
      {"ids", tracks.tracklets.size()},
      {"frames", report.frames},
      {"detections", report.detections},
      {"rows", report.rows},
      {"shared_rows", report.shared_rows},
      {"interpolated_rows", report.filled_rows},
      {"joins", report.joins},
      {"exchanges", report.exchanges},
      {"still_tracks_dropped", report.still_tracks},
      {"static_clutter", report.clutter},
      {"polarity", report.dark ? (report.bright ? "both" : "dark") : "bright"},
      {"separable_share", report.separability.share},
      {"camera_moves", report.camera_moves},
      {"usual_length_px", report.usual_length_px},
      {"usual_contrast", report.usual_contrast},
      {"motion_model", report.correlation > 0 ? "Singer" : "constant velocity"},
      {"acceleration_correlation_frames", report.correlation},
      {"process_noise_sizes", report.noise.acceleration},
      {"measurement_noise_sizes", report.noise.measurement},
      {"speed_sd_px_per_frame", report.noise.speed_sd},
      {"part_seconds",
       {{"decode", t.decode_s},
        {"detect", t.detect_s},
        {"camera", t.camera_s},
        {"associate", t.associate_s},
        {"finish", t.finish_s}}}};
  stage->figures().update(figures);
}

// The last frame of the footage, as far as it is known.
int FrameCount(const TrackerResult& result) {
  int last = static_cast<int>(result.report.frames);
  for (const Tracklet& t : result.tracks.tracklets) {
    if (!t.detections.empty()) last = std::max(last, t.detections.back().frame);
  }
  return last;
}

// What can be said instead of identities.
void MeasureFlow(const TrackCommand& command, const CommonOptions& common, const Progress& progress,
                 Stage* stage) {
  const DensityFlow flow = MeasureDensityFlow(command.tracker.detect, command.video, progress);
  WriteDensityFlow(common.out / "density_flow.csv", flow);
  stage->AddOutput("density_flow.csv");
  stage->figures()["declined"] = true;
  stage->figures()["animals_median"] = flow.median_count;
  stage->figures()["density_per_megapixel"] = 1e6 * flow.median_density;
  stage->figures()["flow_px_per_frame"] = flow.median_speed;
  stage->figures()["polarisation"] = flow.polarisation;
}

// What to look at, the likeliest mistake first. `picture` is what --picture takes.
void SetSuspicions(const std::vector<Suspicion>& suspicions, Stage* stage) {
  constexpr std::size_t kMost = 50;
  constexpr int kAround = 10;  // frames
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < std::min(suspicions.size(), kMost); ++k) {
    const Doubt& d = suspicions[k].doubt;
    list.push_back(
        {{"frame", d.first_frame},
         {"last_frame", d.last_frame},
         {"kind", NameOf(d.kind)},
         {"ids", suspicions[k].ids},
         {"x", std::round(10 * d.position.x) / 10},
         {"y", std::round(10 * d.position.y) / 10},
         {"chance", std::round(1000 * d.chance) / 1000},
         {"picture", fmt::format("{}:{}:{}", std::max(1, d.first_frame - kAround),
                                 d.last_frame + kAround, fmt::join(suspicions[k].ids, ","))}});
  }
  stage->figures()["suspicious_count"] = suspicions.size();
  stage->figures()["suspicious"] = std::move(list);
}

}  // namespace

void RunTrack(const TrackCommand& command, const CommonOptions& common) {
  const bool has_video = !command.video.empty();
  if (!has_video && command.from.empty()) {
    throw CLI::ValidationError("track", "give a video, or --from with what another program found");
  }
  if (!has_video && (command.overlay || !command.pictures.empty())) {
    throw CLI::ValidationError("--overlay and --picture", "there is no video to draw over");
  }
  if (has_video) const VideoSource readable(command.video);  // fails early, says what is wrong
  std::vector<Correction> corrections;
  if (!command.corrections.empty()) corrections = ReadCorrections(command.corrections);

  std::vector<PictureSpan> spans;
  for (const std::string& text : command.pictures) {
    spans.push_back(ParsePictureSpan(text, "--picture"));
  }

  CommonOptions stage_options = common;  // for a picture, tracks that are there need no new run
  stage_options.reuse = common.reuse || !spans.empty();
  Stage stage("track", stage_options);
  stage.options() = OptionsAsJson(command.tracker);
  stage.options()["overlay"] = command.overlay;
  if (common.fps) stage.options()["fps"] = *common.fps;
  if (has_video) {
    const bool is_pattern = !fs::exists(command.video);
    const fs::path folder = command.video.parent_path();
    stage.AddInput(!is_pattern ? command.video : folder.empty() ? fs::path(".") : folder);
  }
  if (!command.from.empty()) {
    stage.options().update(OptionsAsJson(command.foreign));
    stage.options()["size"] = command.size;
    stage.AddInput(command.from);
  }
  if (!command.corrections.empty()) stage.AddInput(command.corrections);
  stage.AddOutput("tracks.csv");
  stage.AddOutput("shapes.csv");
  if (command.overlay) stage.AddOutput("overlay.mp4");
  const auto write_pictures = [&](const Tracks& tracks) {
    for (const PictureSpan& span : spans) {
      WriteTrackPicture(command.video, tracks, span, common.out / NameOfPicture(span));
    }
  };
  if (stage.IsUpToDate()) {
    if (!spans.empty()) write_pictures(ReadTracks(common.out / "tracks.csv"));
    return;
  }

  const Progress progress = stage.BeginPhase("track");
  TrackerResult result = command.from.empty()
                             ? TrackVideo(command.tracker, command.video, progress, common.fps,
                                          {.folder = common.out / ".track-checkpoint"})
                             : TrackFrom(command, common, &stage);
  if (!corrections.empty()) {
    stage.BeginPhase("correct");
    ApplyCorrections(corrections, command.corrections.string(), FrameCount(result), &result.tracks);
  }
  for (const std::string& warning : result.report.warnings) stage.Warn(warning);
  const bool has_declined = has_video && !result.report.separability.is_enough;
  if (has_declined) {
    stage.Warn(WhyDeclined(result.report.separability));
    const Progress flow_progress = stage.BeginPhase("flow");
    MeasureFlow(command, common, flow_progress, &stage);
  } else if (result.tracks.tracklets.empty()) {
    stage.Warn("no animal was found: lower --threshold, or set --polarity and --window");
  }

  if (command.overlay) {
    const Progress overlay_progress = stage.BeginPhase("overlay");
    WriteTrackOverlay(command.video, result.tracks, common.out / "overlay.mp4", overlay_progress);
  }
  stage.BeginPhase("write", "files");
  WriteTracks(common.out / "tracks.csv", result.tracks);
  WriteShapes(common.out / "shapes.csv", result.tracks);
  SetFigures(result.report, result.tracks, &stage);
  SetSuspicions(result.report.suspicions, &stage);
  write_pictures(result.tracks);
  stage.Finish();
}

void AddTrackCommand(CLI::App& app) {
  std::shared_ptr<TrackCommand> command;
  CLI::App* sub = AddSubcommand<TrackCommand>(
      app, "track", "Follow the animals of a video in the picture",
      "Examples:\n"
      "  flocklift track flock.mp4 --out run\n"
      "  flocklift track 'frames/img_%04d.png' --fps 30 --overlay --out run\n"
      "  flocklift track flock.mp4 --corrections corrections.txt --out run\n"
      "  flocklift track flock.mp4 --from trackpy.csv --out run\n"
      "  flocklift track flock.mp4 --picture 118:140:4,7 --out run",
      {.fps = true}, &RunTrack, &command);
  sub->add_option("video", command->video,
                  "a video file, a pattern of pictures (img_%04d.png) or a folder of pictures");
  sub->add_option("--from", command->from,
                  "go on from detections or tracks of another program: a MOTChallenge, trackpy, "
                  "DLTdv, TRex or idtracker.ai file, or the folder of one of the last two");
  sub->add_option("--size", command->size, "WIDTHxHEIGHT of the picture, where no video is given");
  AddFlags(*sub, command->foreign, "Other programs' files", "from-");
  sub->add_flag("--overlay", command->overlay, "write overlay.mp4: the tracks over the footage");
  sub->add_option("--picture", command->pictures,
                  "draw frames for a decision, FIRST:LAST or FIRST:LAST:ID,ID (cut out around "
                  "these); a run that is there is not made again");
  sub->add_option(
      "--corrections", command->corrections,
      "a file of corrections, one a line: swap ID ID FRAME, split ID FRAME, join ID ID, "
      "delete ID [FIRST LAST], pin ID FRAME X Y, add FRAME X Y");
  AddFlags(*sub, command->tracker, "Tracking");
}

}  // namespace flocklift
