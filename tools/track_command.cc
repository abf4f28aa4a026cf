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
#include "simulate/core/table_by_frame.h"
#include "tools/stage.h"
#include "tools/track_from.h"
#include "tools/track_overlay.h"
#include "tools/track_picture.h"
#include "track/correct.h"
#include "track/density_flow.h"
#include "track/tracklet_file.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

void SetFigures(const TrackerReport& report, std::size_t ids, Stage* stage) {
  const TrackerTimings& t = report.timings;
  nlohmann::ordered_json figures = {
      {"frames_per_second",
       static_cast<double>(report.frames - report.frames_before) / std::max(t.total_s, 1e-9)},
      {"ids", ids},
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

// Applies what a person says to all the tracks, which memory must hold for it.
void Correct(const std::vector<Correction>& corrections, const std::string& file,
             const TrackerReport& report, TrackletFile* rows) {
  // The last frame of the footage, as far as it is known.
  const int frames = std::max(static_cast<int>(report.frames), rows->last_frame());
  Tracks tracks{report.fps, rows->All()};
  ApplyCorrections(corrections, file, frames, &tracks);
  rows->Clear();
  for (const Tracklet& tracklet : tracks.tracklets) rows->Add(tracklet);
}

// Of the tracks of an earlier run.
TracksBetween FromTable(const fs::path& path) {
  return [path](int first, int last) {
    const std::optional<TableByFrame> table = TableByFrame::Open(path, "tracks");
    std::optional<Tracks> some = table ? ReadTracks(*table, first, last) : std::nullopt;
    return some ? std::move(*some) : ReadTracks(path);
  };
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
  const auto write_pictures = [&](const TracksBetween& tracks) {
    for (const PictureSpan& span : spans) {
      WriteTrackPicture(command.video, tracks, span, common.out / NameOfPicture(span));
    }
  };
  if (stage.IsUpToDate()) {
    if (!spans.empty()) write_pictures(FromTable(common.out / "tracks.csv"));
    return;
  }

  const Progress progress = stage.BeginPhase("track");
  TrackletFile rows(common.out);
  TrackerReport report;
  if (command.from.empty()) {
    report =
        StreamTracks(command.tracker, command.video, [&rows](const Tracklet& t) { rows.Add(t); },
                     progress, common.fps, {.folder = common.out / ".track-checkpoint"});
  } else {
    TrackerResult result = TrackFrom(command, common, &stage);
    for (const Tracklet& tracklet : result.tracks.tracklets) rows.Add(tracklet);
    report = std::move(result.report);
  }
  if (!corrections.empty()) {
    stage.BeginPhase("correct");
    Correct(corrections, command.corrections.string(), report, &rows);
  }
  for (const std::string& warning : report.warnings) stage.Warn(warning);
  const bool has_declined = has_video && !report.separability.is_enough;
  if (has_declined) {
    stage.Warn(WhyDeclined(report.separability));
    const Progress flow_progress = stage.BeginPhase("flow");
    MeasureFlow(command, common, flow_progress, &stage);
  } else if (rows.size() == 0) {
    stage.Warn("no animal was found: lower --threshold, or set --polarity and --window");
  }

  const TracksBetween tracks = [&rows](int first, int last) { return rows.Between(first, last); };
  if (command.overlay) {
    const Progress overlay_progress = stage.BeginPhase("overlay");
    WriteTrackOverlay(command.video, tracks, report.fps, common.out / "overlay.mp4",
                      overlay_progress);
  }
  stage.BeginPhase("write", "files");
  WriteTracksAndShapes(common.out / "tracks.csv", common.out / "shapes.csv", report.fps, rows);
  SetFigures(report, rows.size(), &stage);
  SetSuspicions(report.suspicions, &stage);
  write_pictures(tracks);
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
