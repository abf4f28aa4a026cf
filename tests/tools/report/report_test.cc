// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "simulate/camera/camera_io.h"
#include "simulate/camera/projection.h"
#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/rng.h"
#include "simulate/media/image_codec.h"
#include "simulate/media/video_writer.h"
#include "tools/report/video_frame.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// In the page's text without its pictures. (Not a matcher: it would print the whole page.)
testing::AssertionResult Contains(const std::string& html, const std::string& text) {
  std::string plain = html;
  const std::string uri = "base64,";
  for (std::size_t at = plain.find(uri); at != std::string::npos; at = plain.find(uri, at + 7)) {
    plain.erase(at + uri.size(), plain.find('"', at) - at - uri.size());
  }
  return (plain.find(text) != std::string::npos ? testing::AssertionSuccess()
                                                : testing::AssertionFailure())
         << '"' << text << '"';
}

Camera TestCamera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.intrinsics = {.fx = 600, .fy = 600, .cx = 319.5, .cy = 239.5};
  camera.fps = 25;
  camera.cam_from_world = LookAt({0, -40, 2}, {0, 0, 10});
  return camera;
}

// Animals on circles, each point's depth wrong by the factor `depth_factor`, ids from `first_id`.
Trajectories Flock(int animals, int frames, double depth_factor, Id first_id) {
  const Rigid3d cam_from_world = *TestCamera().cam_from_world;
  Trajectories flock;
  flock.fps = 25;
  flock.has_sd_depth = true;
  for (int k = 0; k < animals; ++k) {
    Trajectory trajectory{first_id + k, {}};
    for (int frame = 1; frame <= frames; ++frame) {
      const double angle = 0.02 * frame + 0.1 * k, radius = 5 + 0.2 * (k % 20);
      TrajectoryPoint point;
      point.frame = frame;
      const Vec3d truth = {radius * std::cos(angle), radius * std::sin(angle), 8 + 0.1 * (k % 40)};
      point.position = cam_from_world.Inverse() * ((cam_from_world * truth) * depth_factor);
      point.sd_depth = 2;
      trajectory.points.push_back(point);
    }
    flock.trajectories.push_back(trajectory);
  }
  return flock;
}

Tracks Seen(const Trajectories& flock, double shift_px) {
  const Camera camera = TestCamera();
  Tracks tracks;
  tracks.fps = 25;
  for (const Trajectory& trajectory : flock.trajectories) {
    Tracklet tracklet{trajectory.id, {}};
    for (const TrajectoryPoint& point : trajectory.points) {
      Vec2d at = Project(camera.intrinsics, camera.CamFromWorld(point.frame) * point.position);
      at.x -= shift_px;
      tracklet.detections.push_back({point.frame, Box::Around(at, 8, 5), 1, {}});
    }
    tracks.tracklets.push_back(tracklet);
  }
  return tracks;
}

// A film whose frame k is grey level 4 k.
void WriteGreyFilm(const fs::path& path, int frames) {
  VideoWriter video(path, 640, 480, 25);
  for (int frame = 1; frame <= frames; ++frame) {
    Image image(640, 480);
    std::fill(image.bgr.begin(), image.bgr.end(), static_cast<std::uint8_t>(4 * frame));
    video.Write(std::move(image));
  }
  video.Finish();
}

class ReportTest : public testing::Test {
 protected:
  ReportTest() {
    fs::remove_all(folder_);
    fs::create_directories(run_ / "replay");
    fs::create_directories(folder_ / "truth");
  }
  ~ReportTest() override { fs::remove_all(folder_); }

  void FillFolder() const {
    const Trajectories truth = Flock(8, 60, 1, 1), result = Flock(8, 60, 1.1, 101);
    WriteTrajectories(folder_ / "truth/trajectories.csv", truth);
    WriteTracks(folder_ / "truth/tracks_true.csv", Seen(truth, 0));
    WriteTrajectories(run_ / "trajectories.csv", result);
    WriteTracks(run_ / "tracks.csv", Seen(result, 0.5));
    WriteTrajectories(run_ / "replay/trajectories.csv", Flock(8, 60, 1.12, 101));
    WriteCamera(run_ / "camera.yaml", TestCamera());
    WriteGreyFilm(folder_ / "film.mp4", 60);
    WriteTextFile(
        run_ / "summary.track.json",
        R"({"command": "track", "version": "1", "inputs": [{"name": ")" +
            (folder_ / "film.mp4").string() +
            R"(", "sha256": "ab"}], "phases": [{"name": "detect", "wall_s": 3, "cpu_s": 4}],
                      "options": {"gate": 0.5}, "warnings": [],
                      "figures": {"suspicious_count": 1, "suspicious": [{"kind": "swap", "frame": 7,
                      "last_frame": 9, "ids": [1, 4], "chance": 0.25, "picture": "7:9:1,4"}]}})");
    WriteTextFile(run_ / "summary.reconstruct.json",
                  R"({"figures": {"method": "batch", "scale_sd": 0.07, "scale_from": "wingspan",
                      "observability": "image speed", "residuals": [{"name": "speed", "rms": 1.5}]},
                      "phases": [{"name": "solve", "wall_s": 6, "cpu_s": 6}],
                      "warnings": ["the <b>flock</b> is small"]})");
    Parameters parameters;
    parameters.model.name = "boids";
    parameters.model.parameters = {{"alignment", 0.75}, {"cohesion", 0.1}};
    parameters.posterior = {
        {"alignment", "cohesion"}, {0.05, 0.4}, {1, 0.3, 0.3, 1}, {true, false}};
    WriteParameters(run_ / "parameters.toml", parameters);
  }

  std::string Report() const { return MakeReport(ReadRunFolder(run_, {}, {})); }

  fs::path folder_ = fs::path(testing::TempDir()) / "flocklift_report_test";
  fs::path run_ = folder_ / "result";
};

// Every opening tag has its closing tag, properly nested.
void ExpectWellFormed(const std::string& html) {
  const std::set<std::string> kVoid = {"meta", "!DOCTYPE", "br"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = html.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    if (name.front() == '/') {
      ASSERT_FALSE(open.empty()) << "</" << name << " closes nothing";
      ASSERT_EQ("/" + open.back(), name);
      open.pop_back();
    } else if (tag.back() != '/' && kVoid.count(name) == 0) {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty()) << open.back() << " is not closed";
}

TEST_F(ReportTest, ShowsAllThatIsThere) {
  FillFolder();
  const std::string html = Report();
  ExpectWellFormed(html);
  for (const char* id : {"summary", "picture", "suspicious", "space", "depth", "flock", "truth",
                         "residuals", "scale", "parameters", "replay", "timings", "provenance"}) {
    EXPECT_TRUE(Contains(html, "<section id=\"" + std::string(id) + "\">"));
  }
  EXPECT_FALSE(Contains(html, "<section id=\"missing\">"));
  EXPECT_TRUE(Contains(html, "7:9:1,4"));
  EXPECT_TRUE(Contains(html, "data:image/jpeg;base64,"));
  EXPECT_FALSE(Contains(html, "<script"));
  EXPECT_FALSE(Contains(html, "http://"));
  EXPECT_FALSE(Contains(html, "https://"));
  for (const char* number : {">nan", "\"nan", " nan", "Mnan", "-nan", ">inf", "\"inf"}) {
    EXPECT_FALSE(Contains(html, number));
  }
  EXPECT_TRUE(Contains(html, "the &lt;b&gt;flock&lt;/b&gt; is small"));
}

TEST_F(ReportTest, TellsTheRightFigures) {
  FillFolder();
  const std::string html = Report();
  EXPECT_TRUE(Contains(html, "<td>as it is</td><td>10 %</td>"));  // depth error
  EXPECT_TRUE(Contains(html, "\xC3\x97 0.909"));                  // the global scale
  EXPECT_TRUE(Contains(html, "median 0.5 px"));                   // residual
  EXPECT_TRUE(Contains(html, "Medians 0.50 px to the right and 0.00 px downwards"));
  EXPECT_TRUE(Contains(html, "\xC2\xB1 7 %"));  // scale_sd
  EXPECT_TRUE(Contains(html, "wingspan"));
  EXPECT_TRUE(Contains(html,
                       "<td>alignment</td><td>0.75</td><td>0.05</td><td>6.7 %</td>"
                       "<td>yes</td>"));
  EXPECT_TRUE(Contains(html, "in all 9 s"));  // 3 s of tracking, 6 s of solving
  EXPECT_TRUE(Contains(html, "8 identities over 60 frames, 2.4 s at 25 frames/s"));
}

TEST_F(ReportTest, TheSameFilesGiveTheSamePage) {
  FillFolder();
  EXPECT_EQ(Report(), Report());
}

TEST_F(ReportTest, TracksAloneGiveAPageToo) {
  WriteTracks(run_ / "tracks.csv", Seen(Flock(3, 20, 1, 1), 0));
  const std::string html = Report();
  ExpectWellFormed(html);
  EXPECT_TRUE(Contains(html, "<section id=\"missing\">"));
  EXPECT_TRUE(Contains(html, "no trajectories.csv"));
  EXPECT_TRUE(Contains(html, "3 identities over 20 frames"));
}

TEST_F(ReportTest, TrajectoriesWithoutTimeOrCameraGiveAPageToo) {
  Trajectories flock = Flock(3, 20, 1, 1);
  flock.fps.reset();
  flock.has_sd_depth = false;
  WriteTrajectories(run_ / "trajectories.csv", flock);
  const std::string html = Report();
  ExpectWellFormed(html);
  EXPECT_TRUE(Contains(html, "give --fps"));
  EXPECT_TRUE(Contains(html, "no camera file"));
  const std::string timed = MakeReport(ReadRunFolder(run_, {}, 10.0));
  EXPECT_TRUE(Contains(timed, "2 s at 10 frames/s"));
}

TEST_F(ReportTest, ScoresAreShownWithoutTheTruthToo) {
  WriteTracks(run_ / "tracks.csv", Seen(Flock(3, 20, 1, 1), 0));
  WriteTextFile(run_ / "scores.json", R"({"tracks": {"HOTA": 0.875, "<b>": 1}})");
  const std::string html = Report();
  ExpectWellFormed(html);
  EXPECT_TRUE(Contains(html, "<td>HOTA</td><td>0.875</td>"));
  EXPECT_FALSE(Contains(html, "<b>"));
}

TEST_F(ReportTest, TellsWhatEachStageAddsToTheError) {
  FillFolder();
  EXPECT_FALSE(Contains(Report(), "<section id=\"round-trip\">"));
  WriteTextFile(run_ / "scores.json", R"({"round_trip": {"lead_s": 1, "starts": 4, "error_m": 2,
      "straight_on_error_m": 3, "image_error_px": 50, "straight_on_image_error_px": 70, "stages": [
      {"stage": "track", "error_m": 2, "share": 0.75, "share_sd": 0.1, "image_error_px": 50},
      {"stage": "film again", "image_error_px": 0.5, "image_share": "<b>"}, 3, {"stage": 7}]}})");
  const std::string html = Report();
  ExpectWellFormed(html);
  EXPECT_TRUE(Contains(html, "<section id=\"round-trip\">"));
  EXPECT_TRUE(Contains(html, "<td>75.0 \xC2\xB1 10.0</td>"));
  EXPECT_TRUE(Contains(html, "<td>film again</td>"));
  EXPECT_FALSE(Contains(html, "<b>"));
}

TEST_F(ReportTest, ShowsKernelsThatWereFitted) {
  FillFolder();
  EXPECT_FALSE(Contains(Report(), "Fitted kernels"));
  WriteTextFile(run_ / "kernels.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>");
  WriteTextFile(run_ / "kernels.csv",
                "# units: distance m\nkernel,distance,value,sd,low,high,density,known\n"
                "attraction,0.5,0.125,0.01,0.1,0.15,1,1\nattraction,1.5,0.8125,4,-7,8,0,0\n"
                "alignment,2.5,0.0625,0.01,0,0.1,1,1\n");
  WriteTextFile(run_ / "summary.fit.json",
                R"({"figures": {"kernels": [{"name": "attraction", "unit": "1/s^2",
                "nearest": 0.25, "farthest": 3.5, "known_share_of_pairs": 0.875}]}})");
  const std::string html = Report();
  EXPECT_TRUE(Contains(html, "Fitted kernels"));
  EXPECT_NE(html.find("data:image/svg+xml;base64,PHN2ZyB4bWxucz0"), std::string::npos);
  for (const char* const text : {"0.125", "0.0625", "unknown", "1/s^2", "88 %"}) {
    EXPECT_TRUE(Contains(html, text)) << text;
  }
  EXPECT_FALSE(Contains(html, "0.8125"));  // of what is not known no number
}

TEST_F(ReportTest, HostileNamesStayText) {
  FillFolder();
  const fs::path evil = folder_ / "<img src=x onerror=alert(1)>";
  fs::rename(run_, evil);
  WriteTextFile(evil / "summary.fit.json",
                R"({"version": "<script>", "inputs": [{"name": "<svg onload=x>", "sha256": "'\""}],
                    "options": {"<b>": {"x": ["<i>"]}}, "phases": [{"name": "</div>", "wall_s": 1}],
                    "figures": 3, "warnings": "none"})");
  const std::string html = MakeReport(ReadRunFolder(evil, {}, {}));
  ExpectWellFormed(html);
  for (const char* tag : {"<img", "<script", "<svg onload", "<b>", "<i>"}) {
    EXPECT_FALSE(Contains(html, tag));
  }
}

TEST_F(ReportTest, LongSequencesStaySmall) {
  RunFolder run;
  run.folder = run_;
  run.fps = 25;
  run.camera = TestCamera();
  run.trajectories = Flock(80, 3000, 1, 1);
  for (Trajectory& trajectory : run.trajectories->trajectories) {  // rough paths do not simplify
    for (TrajectoryPoint& point : trajectory.points) {
      Rng rng(1, trajectory.id, point.frame);
      point.position += {0.2 * rng.Normal(), 0.2 * rng.Normal(), 0.2 * rng.Normal()};
    }
  }
  ComputeVelocities(25, &*run.trajectories);
  run.tracks = Seen(*run.trajectories, 0);
  EXPECT_LT(MakeReport(std::move(run)).size(), 4'000'000u);
}

TEST_F(ReportTest, DamagedInputIsRefused) {
  EXPECT_THROW(ReadRunFolder(folder_ / "none", {}, {}), InputError);
  EXPECT_THROW(ReadRunFolder(run_, {}, {}), InputError);  // nothing in it
  FillFolder();
  EXPECT_THROW(ReadRunFolder(run_, folder_ / "none", {}), InputError);
  WriteTextFile(run_ / "summary.fit.json", "{ torn");
  EXPECT_THROW(ReadRunFolder(run_, {}, {}), InputError);
}

TEST_F(ReportTest, TheVideoFrameIsTheOneAskedFor) {
  WriteGreyFilm(folder_ / "film.mp4", 50);
  const auto grey = [&](int frame) {
    const auto picture = ReadVideoFrame(folder_ / "film.mp4", frame, 320);
    if (!picture) return -1;
    EXPECT_EQ(picture->width, 640);
    EXPECT_EQ(picture->height, 480);
    const std::string prefix = "data:image/jpeg;base64,";
    std::vector<std::uint8_t> bytes;
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : picture->data_uri.substr(prefix.size())) {
      const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      const std::size_t digit = digits.find(c);
      if (digit == std::string::npos) break;
      word = (word << 6) | static_cast<std::uint32_t>(digit);
      bits += 6;
      if (bits >= 8) bytes.push_back(static_cast<std::uint8_t>(word >> (bits -= 8)));
    }
    const auto image = DecodeImage(bytes);
    if (!image) return -2;
    EXPECT_EQ(image->width, 320);
    return static_cast<int>(image->Row(100)[300]);
  };
  EXPECT_NEAR(grey(1), 4, 2);
  EXPECT_NEAR(grey(37), 148, 2);
  EXPECT_NEAR(grey(50), 200, 2);
  EXPECT_EQ(grey(51), -1);
  EXPECT_FALSE(ReadVideoFrame(folder_ / "none.mp4", 1, 320).has_value());
}

TEST(Base64, TestVectors) {  // RFC 4648, section 10
  const auto encode = [](const std::string& text) {
    return Base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace flocklift
