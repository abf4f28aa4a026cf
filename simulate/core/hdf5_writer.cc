// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/hdf5_handle.h"
#include "simulate/core/table_writer.h"

namespace flocklift::internal {
namespace {

constexpr hsize_t kRowsPerChunk = 4096;

// A growing dataset of one dimension.
class ColumnWriter {
 public:
  // `type`: of the file; H5T_STD_I64LE or H5T_IEEE_F64LE.
  ColumnWriter(const Hdf5Handle& group, const std::string& name, hid_t type) {
    constexpr unsigned kDeflateLevel = 4;
    const hsize_t none = 0, unlimited = H5S_UNLIMITED, chunk = kRowsPerChunk;
    const Hdf5Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties.get(), 1, &chunk);
    H5Pset_shuffle(properties.get());
    H5Pset_deflate(properties.get(), kDeflateLevel);
    H5Pset_obj_track_times(properties.get(), false);  // same rows, same bytes
    dataset_ = Hdf5Handle(H5Dcreate2(group.get(), name.c_str(), type, space.get(), H5P_DEFAULT,
                                     properties.get(), H5P_DEFAULT),
                          H5Dclose);
  }

  // `memory_type` says what `values` holds. False when the file cannot take them.
  bool Append(hid_t memory_type, const void* values, hsize_t count) {
    const hsize_t first = length_;
    length_ += count;
    if (H5Dset_extent(dataset_.get(), &length_) < 0) return false;
    const Hdf5Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Hdf5Handle space(H5Dget_space(dataset_.get()), H5Sclose);
    return H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr) >=
               0 &&
           H5Dwrite(dataset_.get(), memory_type, memory.get(), space.get(), H5P_DEFAULT, values) >=
               0;
  }

 private:
  Hdf5Handle dataset_;
  hsize_t length_ = 0;
};

class Hdf5Writer : public TableWriter {
 public:
  Hdf5Writer(const std::filesystem::path& path, const std::string& group_name,
             const std::vector<std::string>& columns, std::optional<double> fps)
      : path_(path), aside_(path), values_(columns.size()) {
    const SilentHdf5 silent;
    file_ = Hdf5Handle(
        H5Fcreate(aside_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    if (!file_.IsOpen()) Fail();
    const Hdf5Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties.get(), false);
    group_ = Hdf5Handle(
        H5Gcreate2(file_.get(), group_name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
        H5Gclose);
    WriteVersion();
    if (fps) WriteFps(*fps);
    columns_.emplace_back(group_, "frame", H5T_STD_I64LE);
    columns_.emplace_back(group_, "id", H5T_STD_I64LE);
    for (const std::string& name : columns) columns_.emplace_back(group_, name, H5T_IEEE_F64LE);
  }

  void Add(int frame, Id id, std::span<const double> values,
           std::string_view /*end_of_row*/) override {
    FLOCKLIFT_DCHECK(values.size() == values_.size());
    frames_.push_back(frame);
    ids_.push_back(id);
    for (std::size_t k = 0; k < values.size(); ++k) values_[k].push_back(values[k]);
    if (frames_.size() == kRowsPerChunk) Flush();
  }

  void Commit() override {
    Flush();
    const SilentHdf5 silent;
    columns_.clear();
    group_ = Hdf5Handle();
    if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0) Fail();
    file_ = Hdf5Handle();
    aside_.Commit();
  }

 private:
  [[noreturn]] void Fail() const {
    throw std::runtime_error(fmt::format("cannot write {}", path_.string()));
  }

  void Flush() {
    const SilentHdf5 silent;
    const hsize_t count = frames_.size();
    if (count == 0) return;
    bool good = columns_[0].Append(H5T_NATIVE_INT64, frames_.data(), count) &&
                columns_[1].Append(H5T_NATIVE_INT64, ids_.data(), count);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      good = good && columns_[k + 2].Append(H5T_NATIVE_DOUBLE, values_[k].data(), count);
      values_[k].clear();
    }
    frames_.clear();
    ids_.clear();
    if (!good) Fail();
  }

  void WriteVersion() {
    constexpr std::string_view kVersion = FLOCKLIFT_VERSION;
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), kVersion.size());
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate2(group_.get(), "flocklift_version", type.get(),
                                          space.get(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    if (H5Awrite(attribute.get(), type.get(), kVersion.data()) < 0) Fail();
  }

  void WriteFps(double fps) {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(
        H5Acreate2(group_.get(), "fps", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    if (H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &fps) < 0) Fail();
  }

  std::filesystem::path path_;
  AtomicFile aside_;
  Hdf5Handle file_, group_;
  std::vector<ColumnWriter> columns_;
  std::vector<std::int64_t> frames_, ids_;  // rows not yet written
  std::vector<std::vector<double>> values_;
};

}  // namespace

std::unique_ptr<TableWriter> CreateHdf5Writer(const std::filesystem::path& path,
                                              const std::string& group,
                                              const std::vector<std::string>& columns,
                                              std::optional<double> fps) {
  return std::make_unique<Hdf5Writer>(path, group, columns, fps);
}

}  // namespace flocklift::internal
