// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"

namespace flocklift {
namespace {

using Dictionary = std::pair<const char*, cv::aruco::PREDEFINED_DICTIONARY_NAME>;
constexpr std::array<Dictionary, 17> kDictionaries = {{
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
}};

const Dictionary* FindDictionary(const std::string& name) {
  const auto* found = std::find_if(kDictionaries.begin(), kDictionaries.end(),
                                   [&name](const Dictionary& d) { return name == d.first; });
  return found == kDictionaries.end() ? nullptr : found;
}

cv::Mat Gray(const Image& image) {
  const cv::Mat bgr(image.height, image.width, CV_8UC3,
                    const_cast<std::uint8_t*>(image.bgr.data()));
  cv::Mat gray;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

// Moves corners to the saddles of the grey levels; `window` is half the side looked at.
void Refine(const cv::Mat& gray, int window, std::vector<cv::Point2f>* corners) {
  cv::cornerSubPix(gray, *corners, {window, window}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-4});
}

void FindChessboard(const Board& board, const cv::Mat& gray, BoardView* view) {
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(gray, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE) &&
      !cv::findChessboardCornersSB(gray, size, corners,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE)) {
    return;
  }
  double spacing = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < corners.size(); ++k) {
    spacing = std::min(spacing, cv::norm(corners[k] - corners[k - 1]));
  }
  Refine(gray, std::clamp(static_cast<int>(0.3 * spacing), 2, 15), &corners);
  for (int k = 0; k < static_cast<int>(corners.size()); ++k) {
    view->on_board.push_back(
        {board.square * (k % board.columns), board.square * (k / board.columns), 0});
    view->pixels.push_back({corners[k].x, corners[k].y});
  }
}

// Where marker `id` of a ChArUco board lies: its square's column and row on the printed page.
// Programs differ in whether the first square is black, and in whether they count from the top.
struct CharucoLayout {
  int columns, rows, first_white;
  bool from_top;

  // False when the board has no such marker.
  bool Find(int id, int* column, int* row) const {
    int count = 0;
    for (int r = 0; r < rows; ++r) {
      const int on_page = from_top ? r : rows - 1 - r;
      for (int c = 0; c < columns; ++c) {
        if ((c + on_page) % 2 != first_white) continue;
        if (count++ == id) {
          *column = c;
          *row = on_page;
          return true;
        }
      }
    }
    return false;
  }
};

// A detected marker: its corners on the page in squares, and in the picture.
struct Marker {
  std::array<cv::Point2d, 4> on_page, pixels;
};

std::vector<Marker> PlaceMarkers(const CharucoLayout& layout, double marker_in_squares,
                                 const std::vector<int>& ids,
                                 const std::vector<std::vector<cv::Point2f>>& corners) {
  std::vector<Marker> markers;
  const double near = 0.5 - 0.5 * marker_in_squares, far = 0.5 + 0.5 * marker_in_squares;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    int c = 0, r = 0;
    if (!layout.Find(ids[k], &c, &r)) continue;
    Marker marker;
    marker.on_page = {
        {{c + near, r + near}, {c + far, r + near}, {c + far, r + far}, {c + near, r + far}}};
    std::copy_n(corners[k].begin(), 4, marker.pixels.begin());
    markers.push_back(marker);
  }
  return markers;
}

cv::Mat HomographyOf(const std::vector<Marker>& markers) {
  std::vector<cv::Point2d> from, to;
  for (const Marker& marker : markers) {
    from.insert(from.end(), marker.on_page.begin(), marker.on_page.end());
    to.insert(to.end(), marker.pixels.begin(), marker.pixels.end());
  }
  return cv::findHomography(from, to);
}

cv::Point2d Apply(const cv::Mat& h, const cv::Point2d& p) {
  const auto row = [&](int r) {
    return h.at<double>(r, 0) * p.x + h.at<double>(r, 1) * p.y + h.at<double>(r, 2);
  };
  return {row(0) / row(2), row(1) / row(2)};
}

// Root mean square distance of the markers' corners from one flat page [px].
double Misfit(const std::vector<Marker>& markers) {
  const cv::Mat h = HomographyOf(markers);
  if (h.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const Marker& marker : markers) {
    for (std::size_t k = 0; k < 4; ++k) {
      const cv::Point2d off = Apply(h, marker.on_page[k]) - marker.pixels[k];
      sum += off.dot(off);
    }
  }
  return std::sqrt(sum / (4.0 * static_cast<double>(markers.size())));
}

// Corners of the squares between the markers: predicted from the nearest markers, then refined to
// the saddle of the grey levels. (OpenCV 4.6's own interpolation puts them half a pixel off.)
void FindCharuco(const Board& board, const cv::Mat& gray, BoardView* view) {
  constexpr std::size_t kFewestMarkers = 3, kNearest = 4;
  const auto dictionary =
      cv::aruco::getPredefinedDictionary(FindDictionary(board.dictionary)->second);
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> found;
  cv::aruco::detectMarkers(gray, dictionary, found, ids);

  std::vector<Marker> markers;
  double misfit = std::numeric_limits<double>::infinity();
  for (const bool from_top : {true, false}) {
    for (const int first_white : {1, 0}) {
      auto placed = PlaceMarkers({board.columns, board.rows, first_white, from_top},
                                 board.marker / board.square, ids, found);
      if (placed.size() < kFewestMarkers) continue;
      const double its_misfit = Misfit(placed);
      if (its_misfit < 0.7 * misfit) {
        misfit = its_misfit;
        markers = std::move(placed);
      }
    }
  }
  if (markers.empty()) return;
  const double side = cv::norm(markers[0].pixels[0] - markers[0].pixels[1]);
  if (!(misfit < 0.3 * side)) return;  // another board with the same markers

  for (int row = 1; row < board.rows; ++row) {
    for (int column = 1; column < board.columns; ++column) {
      const cv::Point2d corner(column, row);
      const auto distance = [&corner](const Marker& m) {
        return cv::norm(0.5 * (m.on_page[0] + m.on_page[2]) - corner);
      };
      std::stable_sort(markers.begin(), markers.end(),
                       [&](const Marker& a, const Marker& b) { return distance(a) < distance(b); });
      if (distance(markers[0]) > 0.8) continue;  // none touches this corner
      const std::vector<Marker> nearest(
          markers.begin(),
          markers.begin() + static_cast<std::ptrdiff_t>(std::min(kNearest, markers.size())));
      const cv::Mat h = HomographyOf(nearest);
      if (h.empty()) continue;
      const cv::Point2d predicted = Apply(h, corner);
      double to_marker = std::numeric_limits<double>::infinity();
      for (const cv::Point2d& p : nearest[0].pixels) {
        to_marker = std::min(to_marker, cv::norm(p - predicted));
      }
      const int window = std::clamp(static_cast<int>(0.5 * to_marker), 2, 15);
      const cv::Rect2d inside(window + 2, window + 2, gray.cols - 2 * window - 5,
                              gray.rows - 2 * window - 5);
      if (!inside.contains(predicted)) continue;
      std::vector<cv::Point2f> refined{predicted};
      Refine(gray, window, &refined);
      const cv::Point2d moved = cv::Point2d(refined[0]) - predicted;
      if (cv::norm(moved) < 1e-6 || cv::norm(moved) > 0.7 * window) continue;
      view->on_board.push_back({board.square * column, board.square * row, 0});
      view->pixels.push_back({refined[0].x, refined[0].y});
    }
  }
}

// Enough corners, and not all on one line of the board: only then they say something.
bool Constrains(const BoardView& view) {
  constexpr std::size_t kFewest = 6;
  if (view.pixels.size() < kFewest) return false;
  const Vec3d& a = view.on_board.front();
  const Vec3d ab = view.on_board.back() - a;
  return std::any_of(view.on_board.begin(), view.on_board.end(), [&](const Vec3d& p) {
    return std::abs(Cross(ab, p - a).z) > 1e-6 * SquaredNorm(ab);
  });
}

}  // namespace

void CheckBoard(const Board& board) {
  const bool charuco = board.kind == Board::Kind::kCharuco;
  const std::string size = std::to_string(board.columns) + "x" + std::to_string(board.rows);
  Check(board.columns >= 3 && board.rows >= 3 && board.columns <= 100 && board.rows <= 100,
        "a board of " + size + (charuco ? " squares" : " inner corners") +
            " cannot be; 3x3 to 100x100 can");
  Check(std::isfinite(board.square) && board.square > 0, "the square's side must be positive");
  if (!charuco) return;
  Check(board.marker > 0 && board.marker < board.square,
        "the marker's side must lie between 0 and the square's");
  const Dictionary* dictionary = FindDictionary(board.dictionary);
  if (dictionary == nullptr) {
    std::vector<std::string> names;
    for (const Dictionary& known : kDictionaries) names.emplace_back(known.first);
    Check(false,
          "unknown dictionary " + board.dictionary + "; " + SuggestName(board.dictionary, names));
  }
  const int markers = cv::aruco::getPredefinedDictionary(dictionary->second)->bytesList.rows;
  Check(board.columns * board.rows / 2 <= markers,
        board.dictionary + " has too few markers for a board of " + size + " squares");
}

BoardView FindBoard(const Board& board, const Image& image, const std::string& name) {
  CheckBoard(board);
  BoardView view;
  view.name = name;
  if (image.width < 16 || image.height < 16) return view;
  const cv::Mat gray = Gray(image);
  view.sharpness = Sharpness(image);
  try {
    if (board.kind == Board::Kind::kChessboard) {
      FindChessboard(board, gray, &view);
    } else {
      FindCharuco(board, gray, &view);
    }
  } catch (const cv::Exception&) {
    view.pixels.clear();  // pictures that OpenCV stumbles over hold no board
  }
  if (!Constrains(view)) {
    view.pixels.clear();
    view.on_board.clear();
  }
  return view;
}

double Sharpness(const Image& image) {
  cv::Mat laplacian;
  cv::Laplacian(Gray(image), laplacian, CV_16S);
  cv::Scalar mean, sd;
  cv::meanStdDev(laplacian, mean, sd);
  return sd[0] * sd[0];
}

}  // namespace flocklift
