// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <hdf5.h>

#include <chrono>
#include <thread>
#include <vector>

#include "simulate/core/hdf5_handle.h"
#include "simulate/core/io.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

using internal::Hdf5Handle;

// A file that a test fills column by column.
class File {
 public:
  explicit File(const std::filesystem::path& path, const char* group = "/trajectories")
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose),
        group_(H5Gcreate2(file_.get(), group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose) {}

  template <typename T>
  void Add(const char* name, hid_t type, const std::vector<T>& values, int dimensions = 1) {
    const hsize_t sizes[2] = {values.size(), 1};
    const Hdf5Handle space(H5Screate_simple(dimensions, sizes, nullptr), H5Sclose);
    const Hdf5Handle dataset(
        H5Dcreate2(group_.get(), name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  void AddReals(const char* name, const std::vector<double>& values) {
    Add(name, H5T_NATIVE_DOUBLE, values);
  }
  void AddFps(hid_t type, const void* value) {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(
        H5Acreate2(group_.get(), "fps", type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute.get(), type, value);
  }
  void AddGroup(const char* name) {
    Hdf5Handle(H5Gcreate2(group_.get(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  }

 private:
  Hdf5Handle file_, group_;
};

class Hdf5Table : public testing::Test {
 protected:
  // Fills the columns of two rows, except those that the test changes.
  void AddRows(File* file, const std::vector<std::string>& except) const {
    for (const std::string name : {"frame", "id", "x", "y", "z"}) {
      if (std::find(except.begin(), except.end(), name) == except.end()) {
        file->AddReals(name.c_str(), {1, 2});
      }
    }
  }

  // Reads the file and expects a refusal with these words.
  void ExpectRefused(const std::string& words) const {
    try {
      ReadTrajectories(path_);
      ADD_FAILURE() << "was read without complaint";
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(path_.string() + ": ", 0), 0u) << message;
      EXPECT_NE(message.find(words), std::string::npos) << message;
      EXPECT_NE(message.find("; "), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "table.h5";
};

TEST_F(Hdf5Table, AnyNumberTypeWillDo) {
  {
    File file(path_);
    file.Add("frame", H5T_NATIVE_UINT8, std::vector<std::uint8_t>{1, 2});
    file.Add("id", H5T_NATIVE_DOUBLE, std::vector<double>{3, 3});
    file.Add("x", H5T_NATIVE_FLOAT, std::vector<float>{0.5f, 1.5f});
    file.Add("y", H5T_NATIVE_INT, std::vector<int>{-1, -2});
    file.AddReals("z", {7, 8});
    file.AddReals("remark", {0});
    const int fps = 25;
    file.AddFps(H5T_NATIVE_INT, &fps);
  }
  const Trajectories flock = ReadTrajectories(path_);
  EXPECT_EQ(flock.fps, 25.0);
  ASSERT_EQ(flock.trajectories.size(), 1u);
  EXPECT_EQ(flock.trajectories[0].id, 3);
  EXPECT_EQ(flock.trajectories[0].points[1].frame, 2);
  EXPECT_EQ(flock.trajectories[0].points[1].position, (Vec3d{1.5, -2, 8}));
}

TEST_F(Hdf5Table, FpsMayBeText) {
  for (const bool fixed : {true, false}) {
    {
      File file(path_);
      AddRows(&file, {});
      const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
      H5Tset_size(type.get(), fixed ? 16 : H5T_VARIABLE);
      const char text[16] = "30000/1001";
      const char* pointer = text;
      file.AddFps(type.get(), fixed ? static_cast<const void*>(text) : &pointer);
    }
    EXPECT_EQ(ReadTrajectories(path_).fps, 30000.0 / 1001) << fixed;
  }
}

TEST_F(Hdf5Table, ColumnsAreChunkedAndCompressed) {
  Trajectories flock{.fps = 25, .trajectories = {{.id = 1, .points = {}}}};
  for (int frame = 1; frame <= 40000; ++frame) {
    TrajectoryPoint point;
    point.frame = frame;
    point.position = {1, 2, 1.0 / frame};
    flock.trajectories[0].points.push_back(point);
  }
  WriteTrajectories(path_, flock);
  const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  for (const char* name : {"/trajectories/frame", "/trajectories/id", "/trajectories/x",
                           "/trajectories/y", "/trajectories/z"}) {
    const Hdf5Handle dataset(H5Dopen2(file.get(), name, H5P_DEFAULT), H5Dclose);
    ASSERT_TRUE(dataset.IsOpen()) << name;
    const Hdf5Handle properties(H5Dget_create_plist(dataset.get()), H5Pclose);
    EXPECT_EQ(H5Pget_layout(properties.get()), H5D_CHUNKED);
    EXPECT_GE(H5Pget_nfilters(properties.get()), 1);
    const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    EXPECT_EQ(H5Sget_simple_extent_npoints(space.get()), 40000);
  }
  const Hdf5Handle group(H5Gopen2(file.get(), "/trajectories", H5P_DEFAULT), H5Gclose);
  EXPECT_GT(H5Aexists(group.get(), "fps"), 0);
  EXPECT_GT(H5Aexists(group.get(), "flocklift_version"), 0);
  const Trajectories read = ReadTrajectories(path_);  // over several blocks
  ASSERT_EQ(read.trajectories[0].points.size(), 40000u);
  for (const TrajectoryPoint& point : read.trajectories[0].points) {
    ASSERT_EQ(point.position.z, 1.0 / point.frame);  // exactly
  }
}

TEST_F(Hdf5Table, SameRowsSameBytesAtAnotherTime) {
  Tracks tracks{.fps = 25, .tracklets = {{.id = 1, .detections = std::vector<Detection>(1)}}};
  tracks.tracklets[0].detections[0].frame = 1;
  WriteTracks(folder_ / "a.h5", tracks);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 counts in seconds
  WriteTracks(folder_ / "b.h5", tracks);
  EXPECT_EQ(Contents(folder_ / "a.h5"), Contents(folder_ / "b.h5"));
}

TEST_F(Hdf5Table, NotHdf5) {
  std::ofstream(path_) << "frame,id,x,y,z\n1,1,0,0,0\n";
  ExpectRefused("not an HDF5 file");
  std::ofstream(path_, std::ios::trunc).close();
  ExpectRefused("not an HDF5 file");
}

TEST_F(Hdf5Table, OfAnotherName) {
  {
    File file(folder_ / "table.csv");
    AddRows(&file, {});
  }
  path_ = folder_ / "table.csv";
  ExpectRefused("this is an HDF5 file; give it a name that ends in .h5");
}

TEST_F(Hdf5Table, NoGroup) {
  { File file(path_, "/tracks"); }
  ExpectRefused("there is no group /trajectories; put the datasets frame,id,x,y,z into it");
}

TEST_F(Hdf5Table, MissingColumns) {
  for (const char* name : {"frame", "id", "z"}) {
    {
      File file(path_);
      AddRows(&file, {name});
    }
    ExpectRefused(std::string("column ") + name + " is missing");
  }
  {
    File file(path_);
    AddRows(&file, {});
    file.AddReals("vx", {0, 0});
  }
  ExpectRefused("column vy is missing; give its companions");
}

TEST_F(Hdf5Table, WrongColumns) {
  {
    File file(path_);
    AddRows(&file, {"y"});
    file.AddReals("y", {1});
  }
  ExpectRefused("column y has 1 rows, column frame 2");
  {
    File file(path_);
    AddRows(&file, {"y"});
    file.Add("y", H5T_NATIVE_DOUBLE, std::vector<double>{1, 2}, 2);
  }
  ExpectRefused("column y is not one-dimensional");
  {
    File file(path_);
    AddRows(&file, {"y"});
    file.AddGroup("y");
  }
  ExpectRefused("y is not a dataset");
  {
    File file(path_);
    AddRows(&file, {"y"});
    file.Add("y", H5T_C_S1, std::vector<char>{'a', 'b'});
  }
  ExpectRefused("column y does not hold numbers");
}

TEST_F(Hdf5Table, WrongRows) {
  const std::vector<std::tuple<const char*, std::vector<double>, const char*>> faults{
      {"frame", {1, 0}, "row 2: frame 0 is below 1"}, {"frame", {1, 1.5}, "row 2: frame is 1.5"},
      {"frame", {NAN, 1}, "row 1: frame is nan"},     {"id", {0, 1}, "row 1: id 0 is not positive"},
      {"id", {1e300, 1}, "row 1: id is 1e+300"},      {"x", {1, NAN}, "row 2: x is nan"},
      {"z", {1, INFINITY}, "row 2: z is inf"},        {"z", {1, -2e9}, "row 2: z is -2000000000"},
  };
  for (const auto& [name, values, words] : faults) {
    {
      File file(path_);
      AddRows(&file, {name});
      file.AddReals(name, values);
    }
    ExpectRefused(words);
  }
  {
    File file(path_);
    AddRows(&file, {"frame", "id"});
    file.AddReals("frame", {3, 3});
    file.AddReals("id", {4, 4});
  }
  ExpectRefused("row 2: frame 3 of id 4 stands in row 1 already");
  {
    File file(path_);
    AddRows(&file, {});
    file.AddReals("sd_depth", {0, -1});
  }
  ExpectRefused("row 2: sd_depth is -1");
}

TEST_F(Hdf5Table, NoRows) {
  {
    File file(path_);
    for (const char* name : {"frame", "id", "x", "y", "z"}) file.AddReals(name, {});
  }
  ExpectRefused("there are no rows");
}

TEST_F(Hdf5Table, WrongFps) {
  for (const double fps : {0.0, -25.0, static_cast<double>(NAN)}) {
    {
      File file(path_);
      AddRows(&file, {});
      file.AddFps(H5T_NATIVE_DOUBLE, &fps);
    }
    ExpectRefused("the attribute fps is not a positive number");
  }
}

}  // namespace
}  // namespace flocklift
