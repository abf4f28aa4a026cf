// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include "reconstruct/solve/arrow_system.h"
#include "simulate/core/check.h"

namespace flocklift::internal {

void ArrowSystem::GatherBorder() {
  pieces_.clear();
  for (int first = 0; first < n_; first += kColumns) {
    Piece& piece = pieces_.emplace_back();
    piece.first = first;
    const int columns = std::min(kColumns, n_ - first);
    for (int c = 0; c < k_; ++c) {
      if (met_[c] < first + columns && left_[c] > first) piece.border.push_back(c);
    }
    piece.values = border_(piece.border, Eigen::seqN(first, columns));
  }
}

template <int Count>
Columns<Count> ArrowSystem::ReducedTimes(const Eigen::Ref<const Columns<Count>>& x) const {
  Columns<Count> sorted = Columns<Count>::Zero(k_, Count), border(k_, Count);
  ForEachBlock([&](int first, int columns, int met) {
    sorted.topRows(met).noalias() +=
        reduced_border_.block(0, first, met, columns) * x.middleRows(first, columns);
  });
  for (int c = 0; c < k_; ++c) border.row(order_[c]) = sorted.row(c);
  return border;
}

template <int Count>
void ArrowSystem::SubtractReduced(const Columns<Count>& border,
                                  Eigen::Ref<Columns<Count>> x) const {
  Columns<Count> sorted(k_, Count);
  for (int c = 0; c < k_; ++c) sorted.row(c) = border.row(order_[c]);
  ForEachBlock([&](int first, int columns, int met) {
    x.middleRows(first, columns).noalias() -=
        reduced_border_.block(0, first, met, columns).transpose() * sorted.topRows(met);
  });
}

template <int Count>
void ArrowSystem::Multiply(const Eigen::Ref<const Columns<Count>>& x, const Columns<Count>& shared,
                           Eigen::Ref<Columns<Count>> y, Columns<Count>* out) const {
  FLOCKLIFT_DCHECK(!pieces_.empty());
  Columns<Count> border(k_, Count);
  border << x.bottomRows(own_), shared;
  for (int i = 0; i < n_; ++i) {
    const int low = std::max(0, i - kBand + 1);
    const double* row = &band_[At(i, low)] - low;
    Eigen::Matrix<double, 1, Count> sum = row[i] * x.row(i);
    for (int j = low; j < i; ++j) {
      sum += row[j] * x.row(j);
      y.row(j) += row[j] * x.row(i);
    }
    y.row(i) += sum;
  }
  Columns<Count> ends = corner_ * border;
  for (const Piece& piece : pieces_) {
    const Eigen::Index columns = piece.values.cols();
    const Columns<Count> met = border(piece.border, Eigen::all);
    y.middleRows(piece.first, columns).noalias() += piece.values.transpose() * met;
    ends(piece.border, Eigen::all) += piece.values * x.middleRows(piece.first, columns);
  }
  y.bottomRows(own_) += ends.topRows(own_);
  *out += ends.bottomRows(k_ - own_);
}

template <int Count>
void ArrowSystem::Eliminate(Eigen::Ref<Columns<Count>> x, Columns<Count>* shared) const {
  for (int i = 0; i < n_; ++i) {
    const int low = std::max(0, i - kBand + 1);
    const double* row = &factor_[At(i, low)] - low;
    Eigen::Matrix<double, 1, Count> sum = x.row(i);
    for (int j = low; j < i; ++j) sum -= row[j] * x.row(j);
    x.row(i) = sum / row[i];
  }
  const Columns<Count> ends = ReducedTimes<Count>(x.topRows(n_));
  x.bottomRows(own_) -= ends.topRows(own_);
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(x.bottomRows(own_));
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(x.bottomRows(own_));
  *shared -= ends.bottomRows(k_ - own_);
  shared->noalias() -= own_to_shared_.transpose() * x.bottomRows(own_);
}

template <int Count>
void ArrowSystem::Substitute(const Columns<Count>& shared, Eigen::Ref<Columns<Count>> x) const {
  Columns<Count> border(k_, Count);
  border.topRows(own_) = own_to_shared_ * shared;
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(border.topRows(own_));
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(border.topRows(own_));
  x.bottomRows(own_) -= border.topRows(own_);
  border.topRows(own_) = x.bottomRows(own_);
  border.bottomRows(k_ - own_) = shared;
  SubtractReduced<Count>(border, x.topRows(n_));
  for (int i = n_ - 1; i >= 0; --i) {
    const int low = std::max(0, i - kBand + 1);
    const double* row = &factor_[At(i, low)] - low;
    x.row(i) /= row[i];
    for (int j = low; j < i; ++j) x.row(j) -= row[j] * x.row(i);
  }
}

template void ArrowSystem::Multiply<1>(const Eigen::Ref<const Columns<1>>&, const Columns<1>&,
                                       Eigen::Ref<Columns<1>>, Columns<1>*) const;
template void ArrowSystem::Multiply<8>(const Eigen::Ref<const Columns<8>>&, const Columns<8>&,
                                       Eigen::Ref<Columns<8>>, Columns<8>*) const;
template void ArrowSystem::Eliminate<1>(Eigen::Ref<Columns<1>>, Columns<1>*) const;
template void ArrowSystem::Eliminate<8>(Eigen::Ref<Columns<8>>, Columns<8>*) const;
template void ArrowSystem::Substitute<1>(const Columns<1>&, Eigen::Ref<Columns<1>>) const;
template void ArrowSystem::Substitute<8>(const Columns<8>&, Eigen::Ref<Columns<8>>) const;
template Columns<1> ArrowSystem::ReducedTimes<1>(const Eigen::Ref<const Columns<1>>&) const;
template void ArrowSystem::SubtractReduced<1>(const Columns<1>&, Eigen::Ref<Columns<1>>) const;

}  // namespace flocklift::internal
