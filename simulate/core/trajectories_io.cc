// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <cmath>
#include <fstream>
#include <utility>

#include "simulate/core/animal_rows.h"
#include "simulate/core/input_file.h"
#include "simulate/core/io.h"
#include "simulate/core/read_part.h"
#include "simulate/core/table_writer.h"

namespace flocklift {
namespace {

using internal::AnimalRows;
using internal::ReadCsvTable;
using internal::ReadTable;
using internal::TableContents;
using internal::TableLayout;
using internal::TableRow;

enum Column { kX, kY, kZ, kVx, kVy, kVz, kQw, kQx, kQy, kQz, kSdDepth, kColumnCount };
enum Group { kRequired, kVelocity, kOrientation, kDepth, kEndOfGroups };

TableLayout Layout() {
  return {.name = "trajectories",
          .columns = {{"x"},
                      {"y"},
                      {"z"},
                      {"vx", kVelocity},
                      {"vy", kVelocity},
                      {"vz", kVelocity},
                      {"qw", kOrientation, 1},
                      {"qx", kOrientation},
                      {"qy", kOrientation},
                      {"qz", kOrientation},
                      {"sd_depth", kDepth}},
          .group_count = kEndOfGroups - 1};
}

// Rounding in the file is taken out; more than that is an error.
Quaternion CheckedQuaternion(const TableRow& row) {
  constexpr double kRounding = 1e-3, kExact = 1e-7;
  const double* q = row.values + kQw;
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(norm - 1) <= kRounding)) {
    row.Fail(fmt::format("the quaternion qw, qx, qy, qz has the norm {:g}", norm),
             "divide it by its norm");
  }
  const double scale = std::abs(norm - 1) <= kExact ? 1 : 1 / norm;
  return {q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale};
}

TrajectoryPoint CheckedPoint(const TableRow& row) {
  const double* v = row.values;
  if (!(v[kSdDepth] >= 0)) {
    row.Fail(fmt::format("sd_depth is {:g}", v[kSdDepth]),
             "a standard deviation is 0 or more; take the column out when it is not known");
  }
  return {.frame = row.frame,
          .position = {v[kX], v[kY], v[kZ]},
          .velocity = {v[kVx], v[kVy], v[kVz]},
          .world_from_body = CheckedQuaternion(row),
          .sd_depth = v[kSdDepth]};
}

template <typename Read>
Trajectories ReadTrajectoriesWith(const Read& read, bool may_be_empty = false) {
  AnimalRows<TrajectoryPoint> rows;
  const TableContents contents =
      read(Layout(), [&](const TableRow& row) { rows.Add(row.id, CheckedPoint(row), row.line); });
  if (contents.row_count == 0 && !may_be_empty) {
    contents.place.Fail(0, "there are no rows", "give trajectories that hold at least one");
  }
  Trajectories result{.fps = contents.fps,
                      .has_velocity = contents.has[kVelocity],
                      .has_orientation = contents.has[kOrientation],
                      .has_sd_depth = contents.has[kDepth],
                      .trajectories = {}};
  rows.Finish(contents.place, [&](Id id, std::vector<TrajectoryPoint> points) {
    result.trajectories.push_back({id, std::move(points)});
  });
  return result;
}

}  // namespace

Trajectories ReadTrajectories(const std::filesystem::path& path) {
  return ReadTrajectoriesWith(
      [&](const TableLayout& layout, const auto& take) { return ReadTable(path, layout, take); });
}

Trajectories ReadTrajectories(std::istream& stream, const std::string& name) {
  return ReadTrajectoriesWith([&](const TableLayout& layout, const auto& take) {
    return ReadCsvTable(stream, name, layout, take);
  });
}

std::optional<Trajectories> ReadTrajectories(const TableByFrame& table, int first, int last) {
  return internal::ReadPart(table, first, last,
                            [](const auto& read) { return ReadTrajectoriesWith(read, true); });
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const Trajectories& like)
    : has_velocity_(like.has_velocity),
      has_orientation_(like.has_orientation),
      has_sd_depth_(like.has_sd_depth),
      writer_(internal::TableWriter::Create(
          path, Layout(), {true, has_velocity_, has_orientation_, has_sd_depth_}, like.fps, {})) {}
TrajectoryWriter::~TrajectoryWriter() = default;

void TrajectoryWriter::Add(Id id, const TrajectoryPoint& point) {
  std::array<double, kColumnCount> values{};
  std::size_t count = 0;
  const auto append = [&](std::initializer_list<double> numbers) {
    for (const double number : numbers) values[count++] = number;
  };
  const Vec3d& p = point.position;
  const Vec3d& v = point.velocity;
  const Quaternion& q = point.world_from_body;
  append({p.x, p.y, p.z});
  if (has_velocity_) append({v.x, v.y, v.z});
  if (has_orientation_) append({q.w, q.x, q.y, q.z});
  if (has_sd_depth_) append({point.sd_depth});
  writer_->Add(point.frame, id, std::span(values).first(count));
}

void TrajectoryWriter::Commit() { writer_->Commit(); }

void WriteTrajectories(const std::filesystem::path& path, const Trajectories& trajectories) {
  TrajectoryWriter writer(path, trajectories);
  internal::ForEachByFrame(
      trajectories.trajectories, [](const Trajectory& t) -> const auto& { return t.points; },
      [&](Id id, const TrajectoryPoint& point) { writer.Add(id, point); });
  writer.Commit();
}

}  // namespace flocklift
