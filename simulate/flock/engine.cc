// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/engine.h"

#include <stdexcept>
#include <utility>

#include "simulate/flock/engine_impl.h"

namespace flocklift {

template <typename T>
BasicEngine<T>::BasicEngine(const World& world, const std::vector<Swarm>& swarms,
                            const EngineOptions& options)
    : impl_(std::make_unique<Impl>(world, swarms, options)) {}
template <typename T>
BasicEngine<T>::~BasicEngine() = default;
template <typename T>
BasicEngine<T>::BasicEngine(BasicEngine&&) noexcept = default;
template <typename T>
BasicEngine<T>& BasicEngine<T>::operator=(BasicEngine&&) noexcept = default;

template <typename T>
void BasicEngine<T>::Step() {
  impl_->Step();
}

template <typename T>
std::vector<Vec3<float>> BasicEngine<T>::TetrahedraCorners() {
  std::vector<Vec3<float>> corners;
  for (internal::Species<T>& s : impl_->species) s.motion->AppendCorners(&impl_->pool, &corners);
  return corners;
}

template <typename T>
void BasicEngine<T>::SetParameters(const std::string& species, const ModelSpec& change) {
  for (internal::Species<T>& s : impl_->species) {
    if (s.swarm.species == species) return Impl::Change(change, &s);
  }
  throw std::out_of_range("there is no species " + species);
}
template <typename T>
void BasicEngine<T>::MoveGoal(std::size_t index, const Vec3d& position) {
  impl_->MoveGoal(index, position);
}
template <typename T>
void BasicEngine<T>::MovePredator(std::size_t index, const Vec3d& position) {
  const auto now = impl_->predators.all();
  std::vector<Predator> moved(now.begin(), now.end());
  moved.at(index).position = Flattened(impl_->world.dimensions == 2, position);
  StateWriter out;
  out.Put(moved);
  StateReader in(out.bytes());
  impl_->predators.Load(&in);
}
template <typename T>
void BasicEngine<T>::SetWind(const Vec3d& velocity) {
  impl_->world.wind.velocity = velocity;
}

template <typename T>
std::int64_t BasicEngine<T>::steps() const {
  return static_cast<std::int64_t>(impl_->steps);
}
template <typename T>
double BasicEngine<T>::time() const {
  return impl_->Time();
}
template <typename T>
double BasicEngine<T>::MeanNeighbours() const {
  const double animal_steps =
      static_cast<double>(impl_->agents) * static_cast<double>(impl_->steps);
  return animal_steps > 0 ? impl_->neighbour_sum / animal_steps : 0;
}
template <typename T>
double BasicEngine<T>::MdeShare() const {
  const double animal_steps =
      static_cast<double>(impl_->agents) * static_cast<double>(impl_->steps);
  return animal_steps > 0 ? impl_->touched_sum / animal_steps : 0;
}

template class BasicEngine<float>;
template class BasicEngine<double>;

}  // namespace flocklift
