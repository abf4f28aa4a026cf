// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Builds HDF5 tables with columns, types, shapes and values of the fuzzer's choice: random bytes
// would fuzz the HDF5 library, not the reader.

#include <fuzzer/FuzzedDataProvider.h>
#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "simulate/core/hdf5_handle.h"
#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/same.h"

namespace {

using flocklift::internal::Hdf5Handle;

// A column, and how a byte becomes a value that the reader takes: low + scale * byte.
struct ColumnSpec {
  const char* name;
  double low, scale;
};
constexpr std::array<ColumnSpec, 13> kTrajectoryColumns{{{"frame", 1, 1},
                                                         {"id", 1, 1},
                                                         {"x", -20, 0.25},
                                                         {"y", -20, 0.3},
                                                         {"z", 0, 1e-3},
                                                         {"vx", 0, 0.1},
                                                         {"vy", -1e6, 1e4},
                                                         {"vz", 0, 1e-12},
                                                         {"qw", 1, 1e-6},
                                                         {"qx", 0, 1e-5},
                                                         {"qy", 0, 0},
                                                         {"qz", 0, 0},
                                                         {"sd_depth", 0, 0.1}}};
constexpr std::array<ColumnSpec, 7> kTrackColumns{{{"frame", 1, 1},
                                                   {"id", 1, 1},
                                                   {"left", -20, 10},
                                                   {"top", -20, 0.3},
                                                   {"width", 1e-3, 0.5},
                                                   {"height", 1e-6, 1e-3},
                                                   {"confidence", 0, 1.0 / 256}}};

class TableBuilder {
 public:
  TableBuilder(FuzzedDataProvider* choices, hid_t group) : choices_(*choices), group_(group) {}

  // Well made unless the input chooses a defect; what it does not choose is 0.
  void AddColumn(const ColumnSpec& column, std::size_t rows) {
    switch (choices_.ConsumeIntegral<std::uint8_t>()) {
      case 1:
        return;  // left out
      case 2:
        Hdf5Handle(H5Gcreate2(group_, column.name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Gclose);
        return;
      case 3:
        AddText(column.name);
        return;
      case 4:
        AddNumbers(column, rows + choices_.ConsumeIntegralInRange(0, 3), 1);
        return;
      case 5:
        AddNumbers(column, rows, choices_.ConsumeIntegralInRange(0, 3));
        return;
      default:
        AddNumbers(column, rows, 1);
    }
  }

  void AddFps() {
    const Hdf5Handle space(H5Screate(choices_.ConsumeBool() ? H5S_SCALAR : H5S_NULL), H5Sclose);
    if (choices_.ConsumeBool()) {
      const double fps = choices_.ConsumeBool() ? AnyNumber() : 25;
      WriteAttribute(H5T_NATIVE_DOUBLE, space, &fps);
      return;
    }
    std::string text = choices_.ConsumeRandomLengthString(80);
    text.push_back('\0');
    const bool is_variable = choices_.ConsumeBool();
    const char* pointer = text.c_str();
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), is_variable ? H5T_VARIABLE : text.size());
    const auto padding =
        choices_.PickValueInArray({H5T_STR_NULLTERM, H5T_STR_NULLPAD, H5T_STR_SPACEPAD});
    H5Tset_strpad(type.get(), padding);
    WriteAttribute(type.get(), space, is_variable ? static_cast<const void*>(&pointer) : pointer);
  }

 private:
  void WriteAttribute(hid_t type, const Hdf5Handle& space, const void* value) {
    const Hdf5Handle attribute(
        H5Acreate2(group_, "fps", type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute.get(), type, value);
  }

  double AnyNumber() {
    return choices_.ConsumeBool()
               ? choices_.ConsumeFloatingPoint<double>()
               : choices_.PickValueInArray({0.0, -1.0, 0.5, 1e300, 1e-300,
                                            std::numeric_limits<double>::quiet_NaN(),
                                            std::numeric_limits<double>::infinity()});
  }

  void AddText(const char* name) {
    const hsize_t length = 2;
    const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
    Hdf5Handle(
        H5Dcreate2(group_, name, H5T_C_S1, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
  }

  void AddNumbers(const ColumnSpec& column, std::size_t rows, int dimensions) {
    std::vector<double> values(rows);
    for (double& value : values) {
      const std::uint8_t byte = choices_.ConsumeIntegral<std::uint8_t>();
      value = byte < 255 ? column.low + column.scale * byte : AnyNumber();
    }
    const std::array<hsize_t, 3> sizes{rows, 1, 1};
    const Hdf5Handle space(dimensions == 0 ? H5Screate(H5S_SCALAR)
                                           : H5Screate_simple(dimensions, sizes.data(), nullptr),
                           H5Sclose);
    const hid_t type = choices_.PickValueInArray({H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_STD_I64LE,
                                                  H5T_STD_U64BE, H5T_STD_I32LE, H5T_STD_U8LE});
    const Hdf5Handle dataset(
        H5Dcreate2(group_, column.name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    if (rows > 0) {
      H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
  }

  FuzzedDataProvider& choices_;
  hid_t group_;
};

template <typename Columns>
void BuildFile(FuzzedDataProvider* choices, const std::filesystem::path& path, const char* group,
               const Columns& columns) {
  const flocklift::internal::SilentHdf5 silent;
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle table(H5Gcreate2(file.get(), group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Gclose);
  TableBuilder builder(choices, table.get());
  constexpr std::size_t kMostRows = 6;
  const std::size_t rows = kMostRows - choices->ConsumeIntegralInRange<std::size_t>(0, kMostRows);
  for (const ColumnSpec& column : columns) builder.AddColumn(column, rows);
  if (choices->ConsumeBool()) builder.AddFps();
}

void CheckTrajectories(const std::filesystem::path& path) {
  using namespace flocklift;
  Trajectories flock;
  if (!ReadsOrRefuses(path.string(), [&] { flock = ReadTrajectories(path); })) return;
  FLOCKLIFT_REQUIRE(IsOrdered(
      flock.trajectories, [](const Trajectory& t) -> const auto& { return t.points; }));
  const auto binary = ScratchFile("once.h5"), text = ScratchFile("once.csv");
  WriteTrajectories(binary, flock);
  FLOCKLIFT_REQUIRE(Same(flock, ReadTrajectories(binary), 0));
  WriteTrajectories(text, flock);
  FLOCKLIFT_REQUIRE(Same(flock, ReadTrajectories(text), 1e-8));
}

void CheckTracks(const std::filesystem::path& path) {
  using namespace flocklift;
  Tracks tracks;
  if (!ReadsOrRefuses(path.string(), [&] { tracks = ReadTracks(path); })) return;
  FLOCKLIFT_REQUIRE(IsOrdered(
      tracks.tracklets, [](const Tracklet& t) -> const auto& { return t.detections; }));
  const auto binary = ScratchFile("once.h5"), text = ScratchFile("once.csv");
  WriteTracks(binary, tracks);
  FLOCKLIFT_REQUIRE(Same(tracks, ReadTracks(binary), 1.01e-4));
  WriteTracks(text, tracks);
  FLOCKLIFT_REQUIRE(Same(tracks, ReadTracks(text), 1.01e-4));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider choices(data, size);
  const std::filesystem::path path = flocklift::ScratchFile("table.h5");
  if (choices.ConsumeBool()) {
    BuildFile(&choices, path, "/trajectories", kTrajectoryColumns);
    CheckTrajectories(path);
  } else {
    BuildFile(&choices, path, "/tracks", kTrackColumns);
    CheckTracks(path);
  }
  return 0;
}
