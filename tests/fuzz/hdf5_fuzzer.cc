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
#include <vector>

#include "simulate/core/hdf5_handle.h"
#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/same.h"

namespace {

using flocklift::internal::Hdf5Handle;

constexpr std::array<const char*, 13> kTrajectoryColumns{
    "frame", "id", "x", "y", "z", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "sd_depth"};
constexpr std::array<const char*, 7> kTrackColumns{"frame", "id",     "left",      "top",
                                                   "width", "height", "confidence"};

class TableBuilder {
 public:
  TableBuilder(FuzzedDataProvider* choices, hid_t group) : choices_(*choices), group_(group) {}

  void AddColumn(const char* name, std::size_t rows) {
    switch (choices_.ConsumeIntegralInRange(0, 15)) {
      case 0:
        return;  // left out
      case 1:
        Hdf5Handle(H5Gcreate2(group_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        return;
      case 2:
        AddText(name);
        return;
      case 3:
        AddNumbers(name, rows + choices_.ConsumeIntegralInRange(0, 3), 1);
        return;
      case 4:
        AddNumbers(name, rows, choices_.ConsumeIntegralInRange(0, 3));
        return;
      default:
        AddNumbers(name, rows, 1);
    }
  }

  void AddFps() {
    const Hdf5Handle space(H5Screate(choices_.ConsumeBool() ? H5S_SCALAR : H5S_NULL), H5Sclose);
    if (choices_.ConsumeBool()) {
      const double fps = Number();
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

  // Mostly what tables hold, sometimes anything.
  double Number() {
    if (choices_.ConsumeIntegralInRange(0, 7) > 0) return choices_.ConsumeIntegral<std::uint8_t>();
    return choices_.ConsumeBool()
               ? choices_.ConsumeFloatingPoint<double>()
               : choices_.PickValueInArray({0.0, -1.0, 0.5, 1e300, 1e-300, static_cast<double>(NAN),
                                            static_cast<double>(INFINITY)});
  }

  void AddText(const char* name) {
    const hsize_t length = 2;
    const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
    Hdf5Handle(
        H5Dcreate2(group_, name, H5T_C_S1, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
  }

  void AddNumbers(const char* name, std::size_t rows, int dimensions) {
    std::vector<double> values(rows);
    for (double& value : values) value = Number();
    const std::array<hsize_t, 3> sizes{rows, 1, 1};
    const Hdf5Handle space(dimensions == 0 ? H5Screate(H5S_SCALAR)
                                           : H5Screate_simple(dimensions, sizes.data(), nullptr),
                           H5Sclose);
    const hid_t type = choices_.PickValueInArray({H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_STD_I64LE,
                                                  H5T_STD_U64BE, H5T_STD_I32LE, H5T_STD_U8LE});
    const Hdf5Handle dataset(
        H5Dcreate2(group_, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
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
  const std::size_t rows = choices->ConsumeIntegralInRange<std::size_t>(0, 6);
  if (choices->ConsumeBool()) builder.AddFps();
  for (const char* column : columns) builder.AddColumn(column, rows);
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
