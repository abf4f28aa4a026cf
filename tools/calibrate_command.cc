// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/calibrate_command.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "tools/board_search.h"
#include "tools/calibration_report.h"
#include "tools/size_text.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

Board BoardOf(const CalibrateCommand& command) {
  Board board;
  const bool charuco = !command.charuco.empty();
  Check(charuco != !command.board.empty(),
        "say which board it is, by --board 9x6 (a chessboard's inner corners) or --charuco 5x7 "
        "(squares)");
  board.kind = charuco ? Board::Kind::kCharuco : Board::Kind::kChessboard;
  std::tie(board.columns, board.rows) =
      charuco ? ParseSize(command.charuco, "--charuco") : ParseSize(command.board, "--board");
  Check(!charuco || (command.square > 0 && command.marker > 0),
        "a ChArUco board needs --square and --marker");
  if (command.square > 0) board.square = command.square;
  if (charuco) {
    board.marker = command.marker;
    board.dictionary = command.dictionary;
  }
  CheckBoard(board);
  return board;
}

std::string NameOf(const Board& board) {
  return fmt::format("{}x{} {}", board.columns, board.rows,
                     board.kind == Board::Kind::kCharuco ? "ChArUco board" : "chessboard");
}

constexpr int kFramesTried = 200;  // of a video

BoardSearch Search(const CalibrateCommand& command, const Board& board, const CommonOptions& common,
                   Stage* stage) {
  const auto pictures = ExpandPictures(command.pictures);
  for (const auto& path : pictures.empty() ? command.pictures : pictures) stage->AddInput(path);
  BoardSearch search;
  if (pictures.empty()) {
    search = SearchVideo(command.pictures.front(), board, kFramesTried, command.views,
                         common.ThreadCount(), stage->BeginPhase("find board", "frames"));
  } else {
    search = SearchPictures(pictures, board, common.ThreadCount(),
                            stage->BeginPhase("find board", "pictures"));
  }
  stage->EndPhase();
  const auto found = search.views.size();
  if (found < kFewestViews) {
    const std::string looked =
        fmt::format("{} {}", search.looked_at, pictures.empty() ? "frames tried" : "pictures");
    const std::string mend = fmt::format(
        "give at least {} different views of it, and its size as OpenCV counts it", kFewestViews);
    if (!search.without.empty()) {
      throw InputError(search.without.front(), 0,
                       fmt::format("no {} is seen here, and {} different views of one in {}",
                                   NameOf(board), found, looked),
                       mend);
    }
    throw InputError(command.pictures.front().string(), 0,
                     fmt::format("{} different views of a {} in {}", found, NameOf(board), looked),
                     mend);
  }
  if (!search.without.empty()) {
    stage->Warn(fmt::format("no {} is seen in {} of {} pictures ({})", NameOf(board),
                            search.without.size(), search.looked_at, search.without.front()));
  }
  return search;
}

void WarnOfWeakness(const Calibration& calibration, const std::vector<BoardView>& views,
                    Stage* stage) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (calibration.view_kept[i]) continue;
    stage->Warn(fmt::format("{} is left out: its error of {:.2f} px stands out", views[i].name,
                            calibration.view_rms[i]));
  }
  if (calibration.coverage < 0.6) {
    stage->Warn(
        fmt::format("the views cover {:.0f} % of the image; outside, the distortion is "
                    "guessed: show the board near the corners, too",
                    100 * calibration.coverage));
  }
  if (calibration.focal_sd > 0.01) {
    stage->Warn(
        "the focal length is weakly determined: tilt the board more, in several directions");
  }
  if (calibration.reprojection_rms > 1) {
    stage->Warn("the reprojection error is large: is the board flat, and the lens of this model?");
  }
}

}  // namespace

void RunCalibrate(const CalibrateCommand& command, const CommonOptions& common) {
  const Board board = BoardOf(command);
  Stage stage("calibrate", common);
  stage.options() = {{"board", command.board},
                     {"charuco", command.charuco},
                     {"square", command.square},
                     {"marker", command.marker},
                     {"views", command.views}};
  if (!command.charuco.empty()) stage.options()["dictionary"] = command.dictionary;
  if (common.fps) stage.options()["fps"] = *common.fps;
  stage.options().update(OptionsAsJson(command.options));
  stage.AddOutput("camera.yaml");
  const BoardSearch search = Search(command, board, common, &stage);

  stage.BeginPhase("calibrate", "views");
  auto calibration = CalibrateCamera(search.views, search.width, search.height, command.options);
  stage.EndPhase();
  if (!calibration) {
    throw InputError(
        command.pictures.front().string(), 0,
        fmt::format("{} views of the board do not determine a camera", search.views.size()),
        "tilt the board by 20 to 45 degrees in several directions, near and far");
  }
  calibration->camera.fps = common.fps;
  WriteCamera(common.out / "camera.yaml", calibration->camera);

  WarnOfWeakness(*calibration, search.views, &stage);
  stage.figures() = CalibrationFigures(*calibration);
  stage.Finish();
  if (!common.quiet && !common.json) fmt::print("{}", CalibrationTables(*calibration));
}

void AddCalibrateCommand(CLI::App& app) {
  std::shared_ptr<CalibrateCommand> command;
  CLI::App* sub = AddSubcommand<CalibrateCommand>(
      app, "calibrate", "Make a camera file from pictures or a video of a calibration board",
      "Examples:\n"
      "  flocklift calibrate pictures/ --board 9x6 --out run\n"
      "  flocklift calibrate board_*.jpg --charuco 5x7 --square 0.04 --marker 0.03 "
      "--dictionary DICT_5X5_100\n"
      "  flocklift calibrate board.mp4 --board 9x6 --distortion 8\n"
      "Show the board near and far, in every corner of the image, tilted by 20 to 45 degrees in\n"
      "several directions, with the focus and zoom of the footage.",
      {.fps = true}, &RunCalibrate, &command);
  sub->add_option("pictures", command->pictures,
                  "pictures, a folder of them, a pattern such as img_%03d.png, or one video")
      ->required();
  const std::string group = "Board";
  auto* board = sub->add_option("--board", command->board,
                                "a chessboard with COLUMNSxROWS inner corners, as in 9x6")
                    ->group(group);
  sub->add_option("--charuco", command->charuco,
                  "a ChArUco board of COLUMNSxROWS squares, as in 5x7")
      ->excludes(board)
      ->group(group);
  sub->add_option("--square", command->square,
                  "side of a square [m]; of a chessboard it changes nothing")
      ->check(CLI::PositiveNumber)
      ->group(group);
  sub->add_option("--marker", command->marker, "side of a ChArUco marker [m]")
      ->check(CLI::PositiveNumber)
      ->group(group);
  sub->add_option("--dictionary", command->dictionary, "of the markers, by OpenCV's name")
      ->capture_default_str()
      ->group(group);
  sub->add_option("--views", command->views, "at most so many frames of a video are used")
      ->check(CLI::Range(kFewestViews, 1000))
      ->capture_default_str()
      ->group("Calibration");
  AddFlags(*sub, command->options, "Calibration");
}

}  // namespace flocklift
