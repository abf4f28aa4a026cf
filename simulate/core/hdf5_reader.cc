// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "simulate/core/fps.h"
#include "simulate/core/hdf5_handle.h"
#include "simulate/core/hdf5_table.h"
#include "simulate/core/input_file.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

constexpr hsize_t kRowsPerRead = 16384;

// One dataset, read in blocks of rows.
class Column {
 public:
  Column(const Hdf5Handle& group, std::string name, const TablePlace& place)
      : name_(std::move(name)),
        dataset_(H5Dopen2(group.get(), name_.c_str(), H5P_DEFAULT), H5Dclose) {
    if (!dataset_.IsOpen()) {
      place.Fail(0, fmt::format("{} is not a dataset", name_), "make it one, or take it out");
    }
    const Hdf5Handle type(H5Dget_type(dataset_.get()), H5Tclose);
    const H5T_class_t type_class = H5Tget_class(type.get());
    if (type_class != H5T_INTEGER && type_class != H5T_FLOAT) {
      place.Fail(0, fmt::format("column {} does not hold numbers", name_),
                 "store integers or floats");
    }
    is_integer_ = type_class == H5T_INTEGER;
    space_ = Hdf5Handle(H5Dget_space(dataset_.get()), H5Sclose);
    if (H5Sget_simple_extent_ndims(space_.get()) != 1) {
      place.Fail(0, fmt::format("column {} is not one-dimensional", name_),
                 "give it one value a row");
    }
    H5Sget_simple_extent_dims(space_.get(), &length_, nullptr);
  }

  const std::string& name() const { return name_; }
  hsize_t length() const { return length_; }

  // Fills the block that starts at row `first`.
  void Read(hsize_t first, hsize_t count, const TablePlace& place) {
    const Hdf5Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    bool good =
        H5Sselect_hyperslab(space_.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr) >= 0;
    if (is_integer_) {
      integers_.resize(count);
      good = good && H5Dread(dataset_.get(), H5T_NATIVE_INT64, memory.get(), space_.get(),
                             H5P_DEFAULT, integers_.data()) >= 0;
    } else {
      reals_.resize(count);
      good = good && H5Dread(dataset_.get(), H5T_NATIVE_DOUBLE, memory.get(), space_.get(),
                             H5P_DEFAULT, reals_.data()) >= 0;
    }
    if (!good) {
      place.Fail(static_cast<long>(first) + 1, fmt::format("column {} cannot be read", name_),
                 "the file is damaged; make it anew");
    }
  }

  double Real(std::size_t row) const {
    return is_integer_ ? static_cast<double>(integers_[row]) : reals_[row];
  }

  std::int64_t Integer(std::size_t k, const TableRow& row) const {
    if (is_integer_) return integers_[k];
    constexpr double kExact = 9007199254740992;  // 2^53
    const double value = reals_[k];
    if (!(std::abs(value) <= kExact) || value != std::round(value)) {
      row.Fail(fmt::format("{} is {}", name_, value), "give a whole number, or take the row out");
    }
    return static_cast<std::int64_t>(value);
  }

 private:
  std::string name_;
  Hdf5Handle dataset_, space_;
  hsize_t length_ = 0;
  bool is_integer_ = false;
  std::vector<std::int64_t> integers_;
  std::vector<double> reals_;
};

bool HasColumn(const Hdf5Handle& group, const std::string& name) {
  return H5Lexists(group.get(), name.c_str(), H5P_DEFAULT) > 0;
}

// A number, or the text of one.
std::optional<double> AttributeFps(const Hdf5Handle& attribute) {
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) return std::nullopt;
  const H5T_class_t type_class = H5Tget_class(type.get());
  if (type_class == H5T_INTEGER || type_class == H5T_FLOAT) {
    double value = 0;
    if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) return std::nullopt;
    return ParseFps(fmt::format("{}", value));
  }
  if (type_class != H5T_STRING) return std::nullopt;
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), &text) < 0 || text == nullptr) return std::nullopt;
    const std::optional<double> fps = ParseFps(Trim(text));
    H5free_memory(text);
    return fps;
  }
  constexpr std::size_t kLongest = 64;
  std::array<char, kLongest + 1> text{};
  if (H5Tget_size(type.get()) > kLongest) return std::nullopt;
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) return std::nullopt;
  return ParseFps(Trim(text.data()));
}

std::optional<double> ReadFps(const Hdf5Handle& group, const TablePlace& place) {
  if (H5Aexists(group.get(), "fps") <= 0) return std::nullopt;
  const Hdf5Handle attribute(H5Aopen(group.get(), "fps", H5P_DEFAULT), H5Aclose);
  const std::optional<double> fps = AttributeFps(attribute);
  if (!fps) {
    place.Fail(0, "the attribute fps is not a positive number",
               "store a positive number, or a text such as 30000/1001");
  }
  return fps;
}

// The columns that are there, in the layout's order after frame and id; -1 where absent.
std::vector<int> OpenColumns(const Hdf5Handle& group, const TableLayout& layout,
                             TableContents* contents, std::vector<Column>* columns) {
  const TablePlace& place = contents->place;
  contents->has.assign(static_cast<std::size_t>(layout.group_count) + 1, false);
  contents->has[0] = true;
  for (const TableColumn& column : layout.columns) {
    if (HasColumn(group, column.name)) contents->has[static_cast<std::size_t>(column.group)] = true;
  }
  const auto open = [&](const std::string& name, bool is_required) {
    if (!HasColumn(group, name)) {
      place.Fail(0, fmt::format("column {} is missing", name),
                 is_required ? fmt::format("the group /{} must hold {}", layout.name,
                                           layout.RequiredNames())
                             : "give its companions all together or not at all");
    }
    columns->emplace_back(group, name, place);
    if (columns->back().length() != columns->front().length()) {
      place.Fail(0,
                 fmt::format("column {} has {} rows, column frame {}", name,
                             columns->back().length(), columns->front().length()),
                 "give all columns one length");
    }
  };
  open("frame", true);
  open("id", true);
  std::vector<int> column_of(layout.columns.size(), -1);
  for (std::size_t k = 0; k < column_of.size(); ++k) {
    const TableColumn& column = layout.columns[k];
    if (!contents->has[static_cast<std::size_t>(column.group)]) continue;
    column_of[k] = static_cast<int>(columns->size());
    open(column.name, column.group == 0);
  }
  return column_of;
}

Hdf5Handle OpenFile(const std::filesystem::path& path) {
  OpenInput(path);  // tells a missing or unreadable file apart
  const SilentHdf5 silent;
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.IsOpen()) {
    TablePlace{.file = path.string(), .is_text = false}.Fail(
        0, "this is not an HDF5 file", "names that end in .h5 must be; name a CSV otherwise");
  }
  return file;
}

Hdf5Handle OpenGroup(hid_t file, const TableLayout& layout, const TablePlace& place) {
  const std::string name = "/" + layout.name;
  Hdf5Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.IsOpen()) {
    place.Fail(0, fmt::format("there is no group {}", name),
               fmt::format("put the datasets {} into it", layout.RequiredNames()));
  }
  return group;
}

}  // namespace

bool Hdf5BearsThreads() {
  hbool_t bears = 0;
  return H5is_library_threadsafe(&bears) >= 0 && bears > 0;
}

bool IsHdf5Name(const std::filesystem::path& path) { return path.extension() == ".h5"; }

TableContents ReadHdf5Table(std::int64_t open_file, const std::string& name,
                            const TableLayout& layout, const TakeRow& take, const RowSpan& rows) {
  static_assert(std::is_same_v<hid_t, std::int64_t>);
  const SilentHdf5 silent;
  TableContents contents;
  contents.place = {.file = name, .is_text = false};
  const TablePlace& place = contents.place;
  const Hdf5Handle group = OpenGroup(open_file, layout, place);
  contents.fps = ReadFps(group, place);
  std::vector<Column> columns;
  const std::vector<int> column_of = OpenColumns(group, layout, &contents, &columns);
  std::vector<double> values(layout.columns.size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = layout.columns[k].fallback;
  TableRow row{.place = &place, .values = values.data()};
  const hsize_t length = columns.front().length();
  const hsize_t begin = std::min<hsize_t>(rows.first, length);
  const hsize_t end = begin + std::min<hsize_t>(rows.count, length - begin);
  for (hsize_t first = begin; first < end; first += kRowsPerRead) {
    const hsize_t count = std::min(kRowsPerRead, end - first);
    for (Column& column : columns) column.Read(first, count, place);
    for (std::size_t k = 0; k < count; ++k) {
      row.line = static_cast<long>(first + k) + 1;
      row.frame = CheckedFrame(row, columns[0].Integer(k, row));
      row.id = CheckedId(row, columns[1].Integer(k, row), layout.may_lack_id);
      for (std::size_t c = 0; c < values.size(); ++c) {
        if (column_of[c] < 0) continue;
        values[c] = columns[static_cast<std::size_t>(column_of[c])].Real(k);
        CheckMagnitude(row, layout.columns[c].name, values[c]);
      }
      take(row);
      ++contents.row_count;
    }
  }
  return contents;
}

TableContents ReadHdf5Table(const std::filesystem::path& path, const TableLayout& layout,
                            const TakeRow& take, const RowSpan& rows) {
  const Hdf5Handle file = OpenFile(path);
  return ReadHdf5Table(file.get(), path.string(), layout, take, rows);
}

struct Hdf5Frames::Impl {
  TablePlace place;
  Hdf5Handle file, group;
  Column frame;
};

Hdf5Frames::Hdf5Frames(const std::filesystem::path& path, const std::string& table) {
  const SilentHdf5 silent;
  const TablePlace place{.file = path.string(), .is_text = false};
  Hdf5Handle file = OpenFile(path);
  Hdf5Handle group = OpenGroup(file.get(), {.name = table, .columns = {}}, place);
  Column frame(group, "frame", place);
  impl_ = std::make_unique<Impl>(Impl{place, std::move(file), std::move(group), std::move(frame)});
}
Hdf5Frames::~Hdf5Frames() = default;

std::uint64_t Hdf5Frames::size() const { return impl_->frame.length(); }

std::optional<PlacedRow> Hdf5Frames::From(std::uint64_t row) {
  constexpr hsize_t kMost = 64;
  const SilentHdf5 silent;
  const hsize_t end = std::min<hsize_t>(size(), row + kMost);
  for (hsize_t k = row; k < end; ++k) {
    impl_->frame.Read(k, 1, impl_->place);
    const double frame = impl_->frame.Real(0);
    if (frame >= 1 && frame <= kMaxFrame) return PlacedRow{k, static_cast<int>(frame)};
  }
  return std::nullopt;
}

}  // namespace flocklift::internal
