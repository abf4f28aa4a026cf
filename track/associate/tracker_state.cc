// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the flock tracker that saves and restores its state.

#include <map>
#include <stdexcept>
#include <utility>

#include "track/associate/flock_tracker.h"

namespace flocklift {

void FlockTracker::Save(StateWriter* state) const {
  state->Put(noise_);
  state->Put(strays_);
  state->Put(last_frame_);
  state->Put(started_);
  state->Put(begun_);
  state->Put(static_cast<std::uint64_t>(file_->size()));
  state->Put(static_cast<std::uint64_t>(finished_.size()));
  for (std::size_t k = 0; k < finished_.size(); ++k) {
    state->Put(finished_numbers_[k]);
    state->Put(finished_[k].size);
    state->Put(finished_[k].mass);
  }
  state->Put(static_cast<std::uint64_t>(animals_.size()));
  for (const Animal& animal : animals_) {
    state->Put(animal.number);
    state->Put(animal.record.size);
    state->Put(animal.record.mass);
    state->Put(static_cast<std::uint64_t>(animal.newest.size()));
    for (const TrackPoint& sighting : animal.newest) state->Put(sighting);
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

void FlockTracker::Load(StateReader* state) {
  state->Take(&noise_);
  state->Take(&strays_);
  state->Take(&last_frame_);
  state->Take(&started_);
  state->Take(&begun_);
  std::uint64_t bytes = 0, count = 0;
  state->Take(&bytes);
  std::map<std::uint64_t, Sightings> stored;
  file_->GoOn(bytes, [&](std::uint64_t animal, std::uint64_t at, std::size_t rows) {
    stored[animal].AppendStored(*file_, at, rows);
  });
  state->Take(&count);
  finished_.assign(count, {});
  finished_numbers_.assign(count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    state->Take(&finished_numbers_[k]);
    state->Take(&finished_[k].size);
    state->Take(&finished_[k].mass);
    finished_[k].sightings = std::move(stored[finished_numbers_[k]]);
    if (finished_[k].sightings.empty()) throw std::runtime_error("the saved sightings end early");
  }
  state->Take(&count);
  animals_.assign(count, {});
  for (Animal& animal : animals_) {
    state->Take(&animal.number);
    state->Take(&animal.record.size);
    state->Take(&animal.record.mass);
    animal.record.sightings = std::move(stored[animal.number]);
    std::uint64_t newest = 0;
    for (state->Take(&newest); newest > 0; --newest) {
      state->Take(&animal.newest.emplace_back());
    }
    state->Take(&animal.motion);
    state->Take(&animal.moments);
    for (int* value : {&animal.hits, &animal.missed, &animal.age, &animal.hidden,
                       &animal.first_alone, &animal.last_alone}) {
      state->Take(value);
    }
    state->Take(&animal.alone);
    state->Take(&animal.confirmed);
  }
}

}  // namespace flocklift
