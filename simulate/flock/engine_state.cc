// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the engine's flock is now, for whoever looks, and as bytes for whoever goes on later.

#include <stdexcept>

#include "simulate/flock/engine_impl.h"

namespace flocklift {
namespace {

// What is known of an engine's flock from its saved state.
struct SavedHeader {
  std::uint64_t agents = 0, steps = 0;
  double neighbour_sum = 0, touched_sum = 0;
  std::uint64_t next_event = 0;
  Vec3d steady_wind, gust;
};

}  // namespace

template <typename T>
FlockState BasicEngine<T>::State() const {
  const auto predators = impl_->predators.all();
  const std::size_t n = impl_->agents + predators.size();
  FlockState state;
  state.id.resize(n);
  state.position.resize(n);
  state.velocity.resize(n);
  for (std::size_t k = 0; k < n; ++k) state.id[k] = static_cast<Id>(k + 1);
  impl_->ForEach([&state](std::uint64_t agent, const Herd<T>& herd, std::size_t k) {
    state.position[agent] = ToDouble(herd.now.Position(k));
    state.velocity[agent] = ToDouble(herd.now.Velocity(k));
  });
  for (std::size_t k = 0; k < predators.size(); ++k) {
    state.position[impl_->agents + k] = predators[k].position;
    state.velocity[impl_->agents + k] = predators[k].velocity;
  }
  return state;
}

template <typename T>
std::vector<Vec3d> BasicEngine<T>::Accelerations() const {
  std::vector<Vec3d> result(impl_->agents + impl_->predators.all().size());
  impl_->ForEach([&result](std::uint64_t agent, const Herd<T>& herd, std::size_t k) {
    result[agent] = ToDouble(herd.Acceleration(k));
  });
  return result;
}

template <typename T>
std::string BasicEngine<T>::Save() const {
  StateWriter out;
  out.Put(SavedHeader{.agents = impl_->agents,
                      .steps = impl_->steps,
                      .neighbour_sum = impl_->neighbour_sum,
                      .touched_sum = impl_->touched_sum,
                      .next_event = impl_->next_event,
                      .steady_wind = impl_->world.wind.velocity,
                      .gust = impl_->gust});
  for (const GoalSpec& goal : impl_->world.goals) {
    out.Put(goal.position);
    out.Put(goal.waypoints.empty());
  }
  impl_->predators.Save(&out);
  for (const internal::Species<T>& s : impl_->species) {
    const Bodies<T>& b = s.herd.now;
    for (const std::vector<T>* column : {&b.x, &b.y, &b.z, &b.vx, &b.vy, &b.vz}) out.Put(*column);
    out.Put(b.agent);
    s.motion->Save(&out);
  }
  return out.bytes();
}

template <typename T>
void BasicEngine<T>::Load(std::string_view bytes) {
  StateReader in(bytes);
  SavedHeader header;
  in.Take(&header);
  if (header.agents != impl_->agents) {
    throw std::runtime_error("the saved state is of another flock");
  }
  // What events had changed by then is changed again.
  impl_->steps = header.steps;
  impl_->next_event = 0;
  impl_->Happen();
  impl_->next_event = header.next_event;
  impl_->neighbour_sum = header.neighbour_sum;
  impl_->touched_sum = header.touched_sum;
  impl_->world.wind.velocity = header.steady_wind;
  impl_->gust = header.gust;
  for (GoalSpec& goal : impl_->world.goals) {
    in.Take(&goal.position);
    bool follows_no_waypoints = false;
    in.Take(&follows_no_waypoints);
    if (follows_no_waypoints) goal.waypoints.clear();
  }
  impl_->predators.Load(&in);
  for (internal::Species<T>& s : impl_->species) {
    Bodies<T>& b = s.herd.now;
    for (std::vector<T>* column : {&b.x, &b.y, &b.z, &b.vx, &b.vy, &b.vz}) in.Take(column);
    in.Take(&b.agent);
    s.motion->Load(&in);
  }
  if (!in.AtEnd()) throw std::runtime_error("the saved state is of another flock");
}

template FlockState BasicEngine<float>::State() const;
template FlockState BasicEngine<double>::State() const;
template std::vector<Vec3d> BasicEngine<float>::Accelerations() const;
template std::vector<Vec3d> BasicEngine<double>::Accelerations() const;
template std::string BasicEngine<float>::Save() const;
template std::string BasicEngine<double>::Save() const;
template void BasicEngine<float>::Load(std::string_view);
template void BasicEngine<double>::Load(std::string_view);

}  // namespace flocklift
