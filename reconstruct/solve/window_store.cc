// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/window_store.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "simulate/core/state_archive.h"

namespace flocklift::internal {
namespace {

namespace fs = std::filesystem;

// Names are short; the rest is cut off.
using Name = std::array<char, 48>;
Name NameFrom(const std::string& text) {
  Name name{};
  text.copy(name.data(), name.size() - 1);
  return name;
}

using Named = std::vector<std::pair<std::string, double>>;
void PutNamed(const Named& values, StateWriter* out) {
  out->Put(static_cast<std::uint64_t>(values.size()));
  for (const auto& [name, value] : values) {
    out->Put(NameFrom(name));
    out->Put(value);
  }
}

std::string BytesOf(const SolvedWindow& solved) {
  StateWriter out;
  out.Put(static_cast<std::uint64_t>(solved.result.paths.size()));
  for (const SolvedPath& path : solved.result.paths) {
    out.Put(static_cast<std::uint64_t>(path.size()));
    out.Put(path);
  }
  const BatchReport& r = solved.result.report;
  out.Put(std::array{r.initial_cost, r.final_cost, r.scale_sd, r.stiff_boxes});
  out.Put(r.iterations);
  out.Put(std::array{r.converged, r.weak_perspective});
  out.Put(std::array{r.flock_speed, r.size_ratio, r.lean, r.speed_against_size});
  PutNamed(r.spreads, &out);
  out.Put(static_cast<std::uint64_t>(r.terms.size()));
  for (const TermStatistics& term : r.terms) {
    out.Put(NameFrom(term.name));
    out.Put(term.count);
    out.Put(std::array{term.rms, term.outliers});
  }
  const DynamicsReport& d = r.dynamics;
  out.Put(std::array{d.windows, d.kept});
  out.Put(d.hidden);
  out.Put(std::array{d.weight, d.batch_error, d.dynamics_error});
  PutNamed(d.forces, &out);
  for (const double x : solved.belief.mean) out.Put(x);
  for (const double x : solved.belief.information.reshaped()) out.Put(x);
  const FlockBody& body = solved.belief.body;
  const BodyShape& shape = body.image.shape();
  out.Put(body.image.kind());
  out.Put(std::array{shape.length, shape.trunk, shape.amplitude});
  out.Put(std::array{body.length_sd, body.amplitude_sd, body.lean, body.share});
  out.Put(body.weak_perspective);
  return out.bytes();
}

SolvedWindow WindowFrom(std::string_view bytes) {
  StateReader in(bytes);
  SolvedWindow solved;
  const auto size = [&in] {
    std::uint64_t count = 0;
    in.Take(&count);
    return static_cast<std::size_t>(count);
  };
  solved.result.paths.resize(size());
  for (SolvedPath& path : solved.result.paths) {
    path.resize(size());
    in.Take(&path);
  }
  BatchReport& r = solved.result.report;
  for (double* x : {&r.initial_cost, &r.final_cost, &r.scale_sd, &r.stiff_boxes}) in.Take(x);
  in.Take(&r.iterations);
  for (bool* x : {&r.converged, &r.weak_perspective}) in.Take(x);
  for (Uncertain* u : {&r.flock_speed, &r.size_ratio, &r.lean, &r.speed_against_size}) in.Take(u);
  Name name{};
  const auto take_named = [&](Named* values) {
    values->resize(size());
    for (auto& [text, value] : *values) {
      in.Take(&name);
      text = name.data();
      in.Take(&value);
    }
  };
  take_named(&r.spreads);
  r.terms.resize(size());
  for (TermStatistics& term : r.terms) {
    in.Take(&name);
    term.name = name.data();
    in.Take(&term.count);
    in.Take(&term.rms);
    in.Take(&term.outliers);
  }
  DynamicsReport& d = r.dynamics;
  for (int* n : {&d.windows, &d.kept}) in.Take(n);
  in.Take(&d.hidden);
  for (double* x : {&d.weight, &d.batch_error, &d.dynamics_error}) in.Take(x);
  take_named(&d.forces);
  for (double& x : solved.belief.mean) in.Take(&x);
  for (double& x : solved.belief.information.reshaped()) in.Take(&x);
  FlockBody& body = solved.belief.body;
  BodyImage::Kind kind{};
  BodyShape shape;
  in.Take(&kind);
  for (double* x : {&shape.length, &shape.trunk, &shape.amplitude}) in.Take(x);
  body.image = BodyImage(kind, shape);
  for (double* x : {&body.length_sd, &body.amplitude_sd, &body.lean, &body.share}) in.Take(x);
  in.Take(&body.weak_perspective);
  return solved;
}

}  // namespace

// The file: the fingerprint, then for each window its number, the size of its bytes, and these.
WindowStore::WindowStore(fs::path path, std::uint64_t fingerprint) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::uint64_t head = 0;
  {
    std::ifstream file(path_, std::ios::binary);
    file.read(reinterpret_cast<char*>(&head), sizeof head);
    if (file && head == fingerprint) {
      std::error_code error;
      const std::uintmax_t size = fs::file_size(path_, error);
      end_ = sizeof head;
      std::array<std::uint64_t, 2> record{};
      while (file.read(reinterpret_cast<char*>(record.data()), sizeof record)) {
        const std::uint64_t begin = end_ + sizeof record;
        if (begin + record[1] > size) break;
        places_.push_back({record[0], begin, record[1]});
        end_ = begin + record[1];
        file.seekg(static_cast<std::streamoff>(end_));
      }
    }
  }
  if (end_ > 0) return;
  if (path_.has_parent_path()) fs::create_directories(path_.parent_path());
  std::ofstream file(path_, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&fingerprint), sizeof fingerprint);
  file.close();
  if (!file) throw std::runtime_error(path_.string() + " cannot be written");
  end_ = sizeof fingerprint;
}

std::optional<SolvedWindow> WindowStore::Find(std::size_t window) {
  const auto place = std::find_if(places_.begin(), places_.end(),
                                  [window](const Place& p) { return p.window == window; });
  if (place == places_.end()) return std::nullopt;
  std::string bytes(place->size, '\0');
  std::ifstream file(path_, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(place->begin));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw std::runtime_error(path_.string() + " cannot be read");
  return WindowFrom(bytes);
}

void WindowStore::Keep(std::size_t window, const SolvedWindow& solved) {
  if (path_.empty()) return;
  const std::string bytes = BytesOf(solved);
  const std::array<std::uint64_t, 2> record = {window, bytes.size()};
  fs::resize_file(path_, end_);  // a part of a window that a kill left behind
  std::ofstream file(path_, std::ios::binary | std::ios::app);
  file.write(reinterpret_cast<const char*>(record.data()), sizeof record);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error(path_.string() + " cannot be written");
  places_.push_back({window, end_ + sizeof record, bytes.size()});
  end_ += sizeof record + bytes.size();
}

void WindowStore::Remove() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
}

}  // namespace flocklift::internal
