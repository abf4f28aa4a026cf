// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/camera_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <span>

#include "simulate/camera/opencv_yaml.h"
#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/fps.h"
#include "simulate/core/input_file.h"

namespace flocklift {
namespace {

[[noreturn]] void Fail(const OpenCvYaml& yaml, const std::string& key, const std::string& fault,
                       const std::string& mend) {
  throw InputError(yaml.name(), yaml.Line(key), fault, mend);
}

// The matrix of `key` as `rows` x `cols`; a flat list of that many numbers will do.
std::vector<double> MatrixOfSize(const OpenCvYaml& yaml, const std::string& key, int rows,
                                 int cols) {
  YamlMatrix matrix = yaml.Matrix(key);
  const bool flat =
      matrix.rows == 0 && matrix.values.size() == static_cast<std::size_t>(rows) * cols;
  const bool vector = cols == 1 && matrix.rows == 1 && matrix.cols == rows;
  if (!flat && !vector && (matrix.rows != rows || matrix.cols != cols)) {
    const std::string found = matrix.rows == 0 ? fmt::format("{} numbers", matrix.values.size())
                                               : fmt::format("{} x {}", matrix.rows, matrix.cols);
    Fail(yaml, key, fmt::format("{} is {}", key, found),
         fmt::format("it must be {} x {}", rows, cols));
  }
  return std::move(matrix.values);
}

int ReadSize(const OpenCvYaml& yaml, const std::string& key) {
  const double value = yaml.Number(key);
  if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
    Fail(yaml, key, fmt::format("{} is {}", key, value),
         "the size of the image is a positive whole number of pixels");
  }
  return static_cast<int>(value);
}

// Lenses that are calibrated by another model, whose coefficients would be misread.
void RefuseOtherModels(const OpenCvYaml& yaml) {
  const std::string mend = "calibrate with OpenCV's pinhole model (`flocklift calibrate`)";
  if (yaml.Has("fisheye_model") && yaml.Text("fisheye_model") != "0") {
    Fail(yaml, "fisheye_model", "the camera was calibrated as a fisheye", mend);
  }
  for (const char* key : {"distortion_model", "camera_model", "camera_type", "model_type"}) {
    if (!yaml.Has(key)) continue;
    const std::string model = yaml.Text(key);
    const auto names = [&model](std::initializer_list<const char*> words) {
      return std::any_of(words.begin(), words.end(), [&](const char* word) {
        return std::search(model.begin(), model.end(), word,
                           word + std::char_traits<char>::length(word),
                           [](char a, char b) { return (a | 0x20) == (b | 0x20); }) != model.end();
      });
    };
    if (names({"fisheye", "equidistant", "kannala", "mei", "omni", "scaramuzza"})) {
      Fail(yaml, key, "the camera is of another model (a fisheye or mirror)", mend);
    }
  }
  if (yaml.Has("xi")) Fail(yaml, "xi", "the camera was calibrated as omnidirectional", mend);
}

Intrinsics ReadIntrinsics(const OpenCvYaml& yaml, int width) {
  const std::string key = "camera_matrix";
  const std::vector<double> m = MatrixOfSize(yaml, key, 3, 3);
  const std::string form = "it must be [fx 0 cx; 0 fy cy; 0 0 1] in pixels";
  if (m[0] * m[4] - m[1] * m[3] == 0 || m[8] == 0) {
    Fail(yaml, key, "camera_matrix is singular", form);
  }
  if (m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1) {
    Fail(yaml, key, "camera_matrix is not upper triangular with a last row of 0 0 1", form);
  }
  if (m[1] != 0) {
    Fail(yaml, key, fmt::format("camera_matrix has a skew of {}", m[1]),
         "calibrate without skew, as OpenCV does");
  }
  if (m[0] < 0 || m[4] < 0) Fail(yaml, key, "a focal length is negative", form);
  const double smallest = width / 50.0;  // 175 degrees
  if (m[0] < smallest || m[4] < smallest || m[0] > 1e9 || m[4] > 1e9) {
    Fail(yaml, key, fmt::format("focal lengths of {} and {} px do not fit the image", m[0], m[4]),
         "give pixels: millimetres * image width / sensor width");
  }
  Intrinsics k{m[0], m[4], m[2], m[5], {}};

  const YamlMatrix given = yaml.Matrix("distortion_coefficients");
  const std::vector<double>& d = given.values;
  const std::string counts = "give 4, 5, 8 or 12";
  if (given.rows > 1 && given.cols > 1) {
    Fail(yaml, "distortion_coefficients",
         fmt::format("distortion_coefficients is {} x {}", given.rows, given.cols),
         "it must be one row or one column");
  }
  if (d.size() == 14 && (d[12] != 0 || d[13] != 0)) {
    Fail(yaml, "distortion_coefficients", "the sensor is tilted (coefficients 13 and 14)",
         "calibrate without CALIB_TILTED_MODEL");
  }
  if (d.size() != 4 && d.size() != 5 && d.size() != 8 && d.size() != 12 && d.size() != 14) {
    Fail(yaml, "distortion_coefficients",
         fmt::format("there are {} distortion coefficients", d.size()), counts);
  }
  std::copy_n(d.begin(), std::min(d.size(), k.distortion.size()), k.distortion.begin());
  return k;
}

double ReadFps(const OpenCvYaml& yaml) {
  const auto fps = ParseFps(yaml.Text("fps"));
  if (!fps) {
    Fail(yaml, "fps", "fps is not a positive number",
         "write frames per second, or a ratio such as \"30000/1001\"");
  }
  return *fps;
}

// Twelve numbers, row-major 3 x 4, as a transform. What is a rotation up to the rounding of printed
// digits is made one; what is exact to a double's precision stays as it is.
Rigid3d ReadRigid(const OpenCvYaml& yaml, const std::string& key, const std::string& where,
                  std::span<const double> m) {
  constexpr double kRounding = 1e-4, kExact = 1e-14;
  Rigid3d pose{{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}}, {m[3], m[7], m[11]}};
  const auto& r = pose.rotation.m;
  const Vec3d x{r[0], r[1], r[2]}, y{r[3], r[4], r[5]}, z{r[6], r[7], r[8]};
  const double off =
      std::max({std::abs(Dot(x, x) - 1), std::abs(Dot(y, y) - 1), std::abs(Dot(z, z) - 1),
                std::abs(Dot(x, y)), std::abs(Dot(y, z)), std::abs(Dot(z, x))});
  if (!(off <= kRounding)) {
    Fail(yaml, key, fmt::format("the rotation of {} is none: its rows are not orthonormal", where),
         "give a rotation matrix with at least 5 digits (cv::Rodrigues makes one)");
  }
  if (Dot(Cross(x, y), z) < 0) {
    Fail(yaml, key, fmt::format("the rotation of {} is a mirror", where),
         "make its determinant +1: x right, y down, z forward");
  }
  if (off > kExact) {
    Quaternion q = QuaternionFromRotation(pose.rotation);
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    pose.rotation = RotationFromQuaternion({q.w / norm, q.x / norm, q.y / norm, q.z / norm});
  }
  return pose;
}

void ReadExtrinsics(const OpenCvYaml& yaml, Camera* camera) {
  if (yaml.Has("cam_from_world")) {
    camera->cam_from_world = ReadRigid(yaml, "cam_from_world", "cam_from_world",
                                       MatrixOfSize(yaml, "cam_from_world", 3, 4));
  } else if (yaml.Has("r") || yaml.Has("t")) {
    if (!yaml.Has("r") || !yaml.Has("t")) {
      const std::string key = yaml.Has("r") ? "r" : "t";
      Fail(yaml, key, yaml.Has("r") ? "R stands without t" : "t stands without R",
           "give both, or cam_from_world (3 x 4)");
    }
    const std::vector<double> r = MatrixOfSize(yaml, "r", 3, 3);
    const std::vector<double> t = MatrixOfSize(yaml, "t", 3, 1);
    camera->cam_from_world = ReadRigid(
        yaml, "r", "R",
        std::array{r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2]});
  }
  const std::string key = "cam_from_world_per_frame";
  if (!yaml.Has(key)) return;
  const YamlMatrix poses = yaml.Matrix(key);
  if (poses.values.empty() || poses.values.size() % 12 != 0 ||
      (poses.rows > 0 && poses.cols != 12)) {
    Fail(yaml, key, "cam_from_world_per_frame is not F x 12", "give one row of 3 x 4 per frame");
  }
  const std::size_t frames = poses.values.size() / 12;
  camera->cam_from_world_per_frame.reserve(frames);
  for (std::size_t k = 0; k < frames; ++k) {
    camera->cam_from_world_per_frame.push_back(
        ReadRigid(yaml, key, fmt::format("cam_from_world_per_frame, frame {},", k + 1),
                  std::span(poses.values).subspan(12 * k, 12)));
  }
}

// Shortest text that reads back as the same double, with the point that OpenCV puts.
std::string Real(double value) {
  std::string text = fmt::format("{}", value + 0.0);  // no negative zero
  if (text.find_first_of(".en") == std::string::npos) text += '.';
  return text;
}

void AppendMatrix(const std::string& key, std::size_t rows, std::size_t cols,
                  std::span<const double> values, std::string* text) {
  *text += fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [", key,
                       rows, cols);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool new_line = k > 0 && k % cols == 0 && cols > 1;
    *text += (k == 0 ? " " : new_line ? ",\n       " : ", ") + Real(values[k]);
  }
  *text += " ]\n";
}

std::array<double, 12> ToArray(const Rigid3d& pose) {
  const auto& r = pose.rotation.m;
  const Vec3d& t = pose.translation;
  return {r[0], r[1], r[2], t.x, r[3], r[4], r[5], t.y, r[6], r[7], r[8], t.z};
}

}  // namespace

Camera ParseCamera(const std::string& text, const std::string& name) {
  const OpenCvYaml yaml(text, name);
  RefuseOtherModels(yaml);
  Camera camera;
  camera.width = ReadSize(yaml, "image_width");
  camera.height = ReadSize(yaml, "image_height");
  camera.intrinsics = ReadIntrinsics(yaml, camera.width);
  if (yaml.Has("fps")) camera.fps = ReadFps(yaml);
  ReadExtrinsics(yaml, &camera);
  return camera;
}

Camera ReadCamera(const std::filesystem::path& path) {
  std::ifstream stream = OpenInput(path);
  // A video by mistake shows in its first bytes and is not read whole.
  std::string text(1 << 16, ' ');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.find('\0') == std::string::npos) {
    text.append(std::istreambuf_iterator<char>(stream), {});
  }
  return ParseCamera(text, path.string());
}

std::string FormatCamera(const Camera& camera) {
  const Intrinsics& k = camera.intrinsics;
  std::string text = fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n",
                                 camera.width, camera.height);
  if (camera.fps) text += "fps: " + Real(*camera.fps) + "\n";
  AppendMatrix("camera_matrix", 3, 3, std::array{k.fx, 0., k.cx, 0., k.fy, k.cy, 0., 0., 1.},
               &text);
  const auto& d = k.distortion;
  const auto any = [&d](int begin, int end) {
    return std::any_of(d.begin() + begin, d.begin() + end, [](double c) { return c != 0; });
  };
  const std::size_t count = any(8, 12) ? 12 : any(5, 8) ? 8 : 5;
  AppendMatrix("distortion_coefficients", count, 1, std::span(d).first(count), &text);
  if (camera.cam_from_world) {
    AppendMatrix("cam_from_world", 3, 4, ToArray(*camera.cam_from_world), &text);
  }
  if (!camera.cam_from_world_per_frame.empty()) {
    std::vector<double> values;
    for (const Rigid3d& pose : camera.cam_from_world_per_frame) {
      const auto row = ToArray(pose);
      values.insert(values.end(), row.begin(), row.end());
    }
    AppendMatrix("cam_from_world_per_frame", camera.cam_from_world_per_frame.size(), 12, values,
                 &text);
  }
  return text;
}

void WriteCamera(const std::filesystem::path& path, const Camera& camera) {
  WriteTextFile(path, FormatCamera(camera));
}

}  // namespace flocklift
