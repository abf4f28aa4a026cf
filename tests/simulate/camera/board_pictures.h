// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of calibration boards by a known camera, by casting rays: what calibration is tested on.

#ifndef FLOCKLIFT_TESTS_SIMULATE_CAMERA_BOARD_PICTURES_H_
#define FLOCKLIFT_TESTS_SIMULATE_CAMERA_BOARD_PICTURES_H_

#include <algorithm>
#include <cmath>
#include <opencv2/aruco/charuco.hpp>
#include <vector>

#include "simulate/camera/board.h"
#include "simulate/camera/camera.h"
#include "simulate/camera/projection.h"
#include "simulate/core/image.h"
#include "simulate/core/rng.h"

namespace flocklift {

// The printed board: grey levels on the plane z = 0, with a white margin of one square.
class PrintedBoard {
 public:
  explicit PrintedBoard(const Board& board) : board_(board) {
    if (board.kind == Board::Kind::kCharuco) {
      const auto charuco = cv::aruco::CharucoBoard::create(
          board.columns, board.rows, static_cast<float>(board.square),
          static_cast<float>(board.marker),
          cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
      charuco->draw({kTexels * board.columns, kTexels * board.rows}, texture_);
    }
  }

  double width() const { return board_.square * (board_.columns + Extra()); }
  double height() const { return board_.square * (board_.rows + Extra()); }

  // Grey level at a point, x and y from the outer corner of the first square; -1 off the paper.
  double Grey(double x, double y) const {
    const double column = x / board_.square, row = y / board_.square;
    const double columns = board_.columns + Extra(), rows = board_.rows + Extra();
    if (column < -1 || row < -1 || column > columns + 1 || row > rows + 1) return -1;
    if (column < 0 || row < 0 || column >= columns || row >= rows) return 230;
    if (!texture_.empty()) {
      return texture_.at<unsigned char>(static_cast<int>(row * kTexels),
                                        static_cast<int>(column * kTexels)) > 127
                 ? 230
                 : 25;
    }
    return (static_cast<int>(column) + static_cast<int>(row)) % 2 == 0 ? 25 : 230;
  }

 private:
  static constexpr int kTexels = 128;  // a square
  int Extra() const { return board_.kind == Board::Kind::kChessboard ? 1 : 0; }

  Board board_;
  cv::Mat texture_;
};

// Pictures by one camera; its rays are computed once, at the corners of the pixels.
class BoardPhotographer {
 public:
  explicit BoardPhotographer(const Camera& camera) : camera_(camera) {
    columns_ = camera.width + 1;
    rays_.resize(static_cast<std::size_t>(columns_) * (camera.height + 1));
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      const double u = static_cast<double>(k % columns_) - 0.5;
      const double v = static_cast<double>(k / columns_) - 0.5;
      rays_[k] = RayThroughPixel(camera.intrinsics, {u, v}).value_or(Vec2d{});
    }
  }

  // `cam_from_board` places the outer corner of the first square. 4 x 4 samples a pixel, Gaussian
  // noise of the given sd in grey levels.
  Image Take(const PrintedBoard& board, const Rigid3d& cam_from_board, double noise,
             std::uint64_t seed) const {
    const Rigid3d board_from_cam = cam_from_board.Inverse();
    const Vec3d& eye = board_from_cam.translation;
    Image image(camera_.width, camera_.height);
    Rng rng(seed);
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        double sum = 0;
        for (int sample = 0; sample < 16; ++sample) {
          const double x = (sample % 4 + 0.5) / 4, y = (sample / 4 + 0.5) / 4;
          const Vec2d n = Ray(u + x, v + y);
          const Vec3d direction = board_from_cam.rotation * Vec3d{n.x, n.y, 1};
          const double along = -eye.z / direction.z;
          const Vec3d hit = eye + along * direction;
          const double grey = along > 0 ? board.Grey(hit.x, hit.y) : -1;
          sum += grey < 0 ? 120 : grey;
        }
        const double value = sum / 16 + noise * rng.Normal();
        const auto level = static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
        std::fill_n(image.Row(v) + 3 * u, 3, level);
      }
    }
    return image;
  }

 private:
  Vec2d Ray(double x, double y) const {
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const double a = x - i, b = y - j;
    const Vec2d* row = &rays_[static_cast<std::size_t>(j) * columns_ + i];
    const auto mix = [&](double Vec2d::*c) {
      return (1 - b) * ((1 - a) * row[0].*c + a * row[1].*c) +
             b * ((1 - a) * row[columns_].*c + a * row[columns_ + 1].*c);
    };
    return {mix(&Vec2d::x), mix(&Vec2d::y)};
  }

  Camera camera_;
  int columns_;
  std::vector<Vec2d> rays_;
};

// The board at random in front of the camera, tilted by up to `tilt` radians, its middle near the
// middle of the image, filling about half of it.
inline Rigid3d RandomPose(const PrintedBoard& board, const Camera& camera, double tilt, Rng* rng) {
  const double focal = camera.intrinsics.fx;
  const double z = focal * board.width() / (camera.width * rng->Uniform(0.4, 0.7));
  const double reach = 0.18 * camera.width / focal * z;
  const Vec3d middle_in_cam{rng->Uniform(-reach, reach), 0.7 * rng->Uniform(-reach, reach), z};
  const double a = tilt * rng->Uniform(-1, 1), b = tilt * rng->Uniform(-1, 1),
               c = 0.3 * rng->Uniform(-1, 1);
  // Small turns about x, y, z; normalised as a quaternion.
  Quaternion q{1, std::tan(a / 2), std::tan(b / 2), std::tan(c / 2)};
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const auto rotation = RotationFromQuaternion({q.w / norm, q.x / norm, q.y / norm, q.z / norm});
  const Vec3d middle_on_board{board.width() / 2, board.height() / 2, 0};
  return {rotation, middle_in_cam - rotation * middle_on_board};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_CAMERA_BOARD_PICTURES_H_
