// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/sightings.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

static_assert(std::is_trivially_copyable_v<TrackPoint>);

// What stands before a stretch in the file.
struct Head {
  std::uint64_t animal = 0, count = 0;
};

std::span<const TrackPoint>::iterator FirstFrom(std::span<const TrackPoint> rows, int frame) {
  return std::lower_bound(rows.begin(), rows.end(), frame,
                          [](const TrackPoint& p, int wanted) { return p.frame < wanted; });
}

}  // namespace

std::uint64_t SightingFile::Append(std::uint64_t animal, std::span<const TrackPoint> rows) {
  const Head head{animal, rows.size()};
  file_.Append(std::as_bytes(std::span(&head, 1)));
  return file_.Append(std::as_bytes(rows));
}

void SightingFile::Read(std::uint64_t at, std::span<TrackPoint> rows) const {
  file_.Read(at, std::as_writable_bytes(rows));
}

void SightingFile::GoOn(std::uint64_t size, const TakeStretch& take) {
  file_.GoOn(size);
  std::uint64_t at = 0;
  while (at < size) {
    Head head;
    if (size - at < sizeof head) throw std::runtime_error("the saved sightings end early");
    file_.Read(at, std::as_writable_bytes(std::span(&head, 1)));
    at += sizeof head;
    if (head.count == 0 || (size - at) / sizeof(TrackPoint) < head.count) {
      throw std::runtime_error("the saved sightings end early");
    }
    take(head.animal, at, head.count);
    at += head.count * sizeof(TrackPoint);
  }
}

void Sightings::Add(Stretch stretch) {
  FLOCKLIFT_DCHECK(empty() || last_frame() < stretch.first);
  size_ += stretch.count;
  stretches_.push_back(std::move(stretch));
}

void Sightings::Append(std::vector<TrackPoint> rows) {
  if (rows.empty()) return;
  rows.shrink_to_fit();
  Stretch stretch{rows.front().frame, rows.back().frame, rows.size()};
  stretch.rows = std::move(rows);
  Add(std::move(stretch));
}

void Sightings::Append(std::span<const TrackPoint> rows, std::uint64_t animal, SightingFile* file) {
  if (rows.empty()) return;
  file_ = file;
  Add({rows.front().frame, rows.back().frame, rows.size(), file->Append(animal, rows)});
}

void Sightings::AppendStored(const SightingFile& file, std::uint64_t at, std::size_t count) {
  file_ = &file;
  TrackPoint first, last;
  file.Read(at, {&first, 1});
  file.Read(at + (count - 1) * sizeof(TrackPoint), {&last, 1});
  Add({first.frame, last.frame, count, at});
}

void Sightings::Append(Sightings later) {
  if (later.file_ != nullptr) file_ = later.file_;
  stretches_.reserve(stretches_.size() + later.stretches_.size());
  for (Stretch& stretch : later.stretches_) Add(std::move(stretch));
}

Sightings Sightings::CutFrom(int frame) {
  Sightings tail;
  tail.file_ = file_;
  const std::size_t k = FirstStretch(frame);
  if (k == stretches_.size()) return tail;
  std::size_t kept = k;
  if (stretches_[k].first < frame) {
    Stretch& cut = stretches_[k];
    std::vector<TrackPoint> buffer;
    const std::span<const TrackPoint> rows = RowsOf(cut, &buffer);
    const std::size_t before = static_cast<std::size_t>(FirstFrom(rows, frame) - rows.begin());
    Stretch later{rows[before].frame, cut.last, cut.count - before};
    cut.last = rows[before - 1].frame;
    cut.count = before;
    if (cut.rows.empty()) {
      later.at = cut.at + before * sizeof(TrackPoint);
    } else {
      later.rows.assign(rows.begin() + static_cast<std::ptrdiff_t>(before), rows.end());
      cut.rows.resize(before);
    }
    size_ -= later.count;
    tail.Add(std::move(later));
    ++kept;
  }
  for (std::size_t j = kept; j < stretches_.size(); ++j) {
    size_ -= stretches_[j].count;
    tail.Add(std::move(stretches_[j]));
  }
  stretches_.resize(kept);
  return tail;
}

std::span<const TrackPoint> Sightings::RowsOf(const Stretch& stretch,
                                              std::vector<TrackPoint>* buffer) const {
  if (!stretch.rows.empty()) return stretch.rows;
  buffer->resize(stretch.count);
  file_->Read(stretch.at, *buffer);
  return *buffer;
}

std::size_t Sightings::FirstStretch(int frame) const {
  const auto found = std::lower_bound(stretches_.begin(), stretches_.end(), frame,
                                      [](const Stretch& s, int wanted) { return s.last < wanted; });
  return static_cast<std::size_t>(found - stretches_.begin());
}

std::vector<TrackPoint> Sightings::All() const {
  std::vector<TrackPoint> all, buffer;
  all.reserve(size_);
  for (const Stretch& stretch : stretches_) {
    const std::span<const TrackPoint> rows = RowsOf(stretch, &buffer);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

std::vector<TrackPoint> Sightings::Between(int first_frame, int last_frame) const {
  std::vector<TrackPoint> found, buffer;
  for (std::size_t k = FirstStretch(first_frame);
       k < stretches_.size() && stretches_[k].first <= last_frame; ++k) {
    const std::span<const TrackPoint> rows = RowsOf(stretches_[k], &buffer);
    found.insert(found.end(), FirstFrom(rows, first_frame), FirstFrom(rows, last_frame + 1));
  }
  return found;
}

std::vector<TrackPoint> Sightings::Before(int frame, std::size_t most) const {
  std::size_t begin = std::min(FirstStretch(frame) + 1, stretches_.size());
  const std::size_t end = begin;
  std::vector<std::vector<TrackPoint>> parts;  // the last first
  std::size_t count = 0;
  std::vector<TrackPoint> buffer;
  while (begin > 0 && count < most) {
    const std::span<const TrackPoint> rows = RowsOf(stretches_[--begin], &buffer);
    const auto before = begin + 1 == end ? FirstFrom(rows, frame) : rows.end();
    const std::size_t some =
        std::min(most - count, static_cast<std::size_t>(before - rows.begin()));
    parts.emplace_back(before - static_cast<std::ptrdiff_t>(some), before);
    count += some;
  }
  std::vector<TrackPoint> found;
  found.reserve(count);
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    found.insert(found.end(), part->begin(), part->end());
  }
  return found;
}

std::vector<TrackPoint> Sightings::From(int frame, std::size_t most) const {
  std::vector<TrackPoint> found, buffer;
  for (std::size_t k = FirstStretch(frame); k < stretches_.size() && found.size() < most; ++k) {
    const std::span<const TrackPoint> rows = RowsOf(stretches_[k], &buffer);
    const auto from = FirstFrom(rows, frame);
    const std::size_t some =
        std::min(most - found.size(), static_cast<std::size_t>(rows.end() - from));
    found.insert(found.end(), from, from + static_cast<std::ptrdiff_t>(some));
  }
  return found;
}

std::vector<TrackPoint> Sightings::First(std::size_t most) const {
  return empty() ? std::vector<TrackPoint>{} : From(first_frame(), most);
}

std::vector<TrackPoint> Sightings::Last(std::size_t most) const {
  return empty() ? std::vector<TrackPoint>{} : Before(last_frame() + 1, most);
}

const TrackPoint& SightingReader::operator[](std::size_t k) const {
  while (k >= before_ + rows_.size()) {
    before_ += rows_.size();
    rows_ = sightings_->RowsOf(sightings_->stretches_[stretch_++], &buffer_);
  }
  return rows_[k - before_];
}

}  // namespace flocklift
