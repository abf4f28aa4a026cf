// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the flock tracker that saves and restores its state. The log is a list of pieces:
// a track's number, how many sightings follow, these. A track that ended may have fewer sightings
// than the log holds of it: the last ones were taken back.

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "track/associate/flock_tracker.h"

namespace flocklift {
namespace {

using Sightings = std::vector<TrackPoint>;

void AppendPiece(std::uint64_t number, const Sightings& sightings, std::uint64_t* logged,
                 StateWriter* log) {
  if (*logged >= sightings.size()) return;
  log->Put(number);
  log->Put(Sightings(sightings.begin() + static_cast<std::ptrdiff_t>(*logged), sightings.end()));
  *logged = sightings.size();
}

std::map<std::uint64_t, Sightings> ReadLog(std::string_view bytes) {
  std::map<std::uint64_t, Sightings> tracks;
  for (StateReader log(bytes); !log.AtEnd();) {
    std::uint64_t number = 0, count = 0;
    log.Take(&number);
    log.Take(&count);
    Sightings& sightings = tracks[number];
    for (std::uint64_t k = 0; k < count; ++k) {
      TrackPoint sighting;
      log.Take(&sighting);
      sightings.push_back(sighting);
    }
  }
  return tracks;
}

Sightings FirstOf(Sightings* logged, std::uint64_t count) {
  if (logged->size() < count) throw std::runtime_error("the saved sightings end early");
  logged->resize(count);
  logged->shrink_to_fit();
  return std::move(*logged);
}

}  // namespace

void FlockTracker::Save(StateWriter* state, StateWriter* log) {
  state->Put(noise_);
  state->Put(strays_);
  state->Put(last_frame_);
  state->Put(started_);
  state->Put(begun_);
  state->Put(static_cast<std::uint64_t>(finished_.size()));
  for (std::size_t k = 0; k < finished_.size(); ++k) {
    const TrackRecord& record = finished_[k];
    Logged& logged = finished_logged_[k];
    AppendPiece(logged.number, record.sightings, &logged.sightings, log);
    state->Put(logged.number);
    state->Put(static_cast<std::uint64_t>(record.sightings.size()));
    state->Put(record.size);
    state->Put(record.mass);
  }
  state->Put(static_cast<std::uint64_t>(animals_.size()));
  for (Animal& animal : animals_) {
    AppendPiece(animal.logged.number, animal.record.sightings, &animal.logged.sightings, log);
    state->Put(animal.logged);
    state->Put(animal.record.size);
    state->Put(animal.record.mass);
    state->Put(animal.motion);
    state->Put(animal.moments);
    for (const int value : {animal.hits, animal.missed, animal.age, animal.hidden,
                            animal.first_alone, animal.last_alone}) {
      state->Put(value);
    }
    state->Put(animal.alone);
    state->Put(animal.confirmed);
  }
}

void FlockTracker::Load(StateReader* state, std::string_view log) {
  std::map<std::uint64_t, Sightings> logged = ReadLog(log);
  state->Take(&noise_);
  state->Take(&strays_);
  state->Take(&last_frame_);
  state->Take(&started_);
  state->Take(&begun_);
  std::uint64_t count = 0;
  state->Take(&count);
  finished_.assign(count, {});
  finished_logged_.assign(count, {});
  for (std::size_t k = 0; k < count; ++k) {
    std::uint64_t sightings = 0;
    state->Take(&finished_logged_[k].number);
    state->Take(&sightings);
    state->Take(&finished_[k].size);
    state->Take(&finished_[k].mass);
    finished_[k].sightings = FirstOf(&logged[finished_logged_[k].number], sightings);
    finished_logged_[k].sightings = sightings;
  }
  state->Take(&count);
  animals_.assign(count, {});
  for (Animal& animal : animals_) {
    state->Take(&animal.logged);
    state->Take(&animal.record.size);
    state->Take(&animal.record.mass);
    state->Take(&animal.motion);
    state->Take(&animal.moments);
    for (int* value : {&animal.hits, &animal.missed, &animal.age, &animal.hidden,
                       &animal.first_alone, &animal.last_alone}) {
      state->Take(value);
    }
    state->Take(&animal.alone);
    state->Take(&animal.confirmed);
    animal.record.sightings = FirstOf(&logged[animal.logged.number], animal.logged.sightings);
  }
}

}  // namespace flocklift
