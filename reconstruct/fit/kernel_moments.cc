// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_moments.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kPlacesAnOctave = 4;
constexpr int kParts = 4;        // of the work, each with sums of its own
constexpr Index kGathered = 64;  // rows of a bin that are multiplied at once

// One-sided at the end of a track; nothing for an animal that is there for one frame only.
std::optional<Vec3d> Velocity(const ObservedFlock& flock, int animal, int frame) {
  const int before = flock.Has(animal, frame - 1) ? 1 : 0;
  const int after = flock.Has(animal, frame + 1) ? 1 : 0;
  if (before + after == 0) return std::nullopt;
  return (flock.Position(animal, frame + after) - flock.Position(animal, frame - before)) /
         ((before + after) * flock.dt());
}

double Coordinate(const Vec3d& v, int c) { return c == 0 ? v.x : c == 1 ? v.y : v.z; }

// The sums of one part of the work.
class Gatherer {
 public:
  Gatherer(const KernelDesign& design, const std::vector<ObservedFlock>& flocks,
           const std::vector<ObservedFlock>& moved, const std::map<int, KernelModes>& modes)
      : design_(design), flocks_(flocks), moved_(moved), modes_(modes) {
    sums_.terms = design.terms();
    sums_.relaxation = MatrixXd::Zero(sums_.terms, sums_.terms);
  }

  void Add(const KernelRun& run) {
    const ObservedFlock& flock = flocks_[run.flock];
    const ObservedFlock& moved = moved_[run.flock];
    const KernelModes& modes = modes_.at(run.frames);
    const int p = sums_.terms;
    std::array<MatrixXd, 3> features;
    for (MatrixXd& f : features) f = MatrixXd::Zero(run.frames, p);
    std::vector<Vec3d> terms;
    std::vector<double> divergence(static_cast<std::size_t>(p));
    MatrixXd own = MatrixXd::Zero(p, run.frames);
    // Of order 2 the end frames have no velocity of this run, and weight 0.
    const int inset = design_.order - 1;
    for (int k = inset; k < run.frames - inset; ++k) {
      if (!KernelTerms(design_, flock, moved, run.animal, run.first + k, &terms,
                       divergence.data())) {
        return;
      }
      for (int t = 0; t < p; ++t) {
        const Vec3d& term = terms[static_cast<std::size_t>(t)];
        features[0](k, t) = term.x;
        features[1](k, t) = term.y;
        features[2](k, t) = term.z;
        own(t, k) = divergence[static_cast<std::size_t>(t)];
      }
      const double n = std::max(2, flock.Count(run.first + k));
      sums_.relaxation.selfadjointView<Eigen::Lower>().rankUpdate(own.col(k), n / (n - 1));
    }
    for (int c = 0; c < 3; ++c) {
      if (!design_.coordinates[static_cast<std::size_t>(c)]) continue;
      Eigen::VectorXd x(run.frames);
      const double origin = Coordinate(moved.Position(run.animal, run.first), c);
      for (int k = 0; k < run.frames; ++k) {
        x[k] = Coordinate(moved.Position(run.animal, run.first + k), c) - origin;
      }
      MatrixXd rows(modes.modes(), p + 1);
      rows.leftCols(p).noalias() = modes.average * features[static_cast<std::size_t>(c)];
      rows.col(p).noalias() = modes.difference * x;
      for (int j = 0; j < modes.modes(); ++j) AddRow(modes.lambda[j], rows.row(j));
    }
    MatrixXd& sum = sums_.divergence[run.frames];
    if (sum.size() == 0) {
      sum = own;
    } else {
      sum += own;
    }
    ++sums_.runs;
    sums_.frames += run.frames;
  }

  KernelMoments Finish() {
    for (auto& [place, gathered] : gathered_) Multiply(place, &gathered);
    return std::move(sums_);
  }

 private:
  struct Gathered {
    MatrixXd rows;
    Index count = 0;
  };

  void AddRow(double lambda, const Eigen::Ref<const Eigen::RowVectorXd>& row) {
    const int place =
        static_cast<int>(std::floor(kPlacesAnOctave * std::log2(std::max(lambda, 1e-300))));
    Gathered& gathered = gathered_[place];
    if (gathered.rows.size() == 0) gathered.rows.resize(kGathered, sums_.terms + 1);
    gathered.rows.row(gathered.count++) = row;
    KernelBin& bin = sums_.bins[place];
    bin.lambda += lambda;
    bin.rows += 1;
    if (gathered.count == kGathered) Multiply(place, &gathered);
  }

  void Multiply(int place, Gathered* gathered) {
    MatrixXd& moment = sums_.bins[place].moment;
    if (moment.size() == 0) moment = MatrixXd::Zero(sums_.terms + 1, sums_.terms + 1);
    if (gathered->count == 0) return;  // Eigen divides by it
    moment.selfadjointView<Eigen::Lower>().rankUpdate(
        gathered->rows.topRows(gathered->count).transpose());
    gathered->count = 0;
  }

  const KernelDesign& design_;
  const std::vector<ObservedFlock>& flocks_;
  const std::vector<ObservedFlock>& moved_;
  const std::map<int, KernelModes>& modes_;
  KernelMoments sums_;
  std::map<int, Gathered> gathered_;
};

void AddTo(const KernelMoments& part, KernelMoments* sum) {
  for (const auto& [place, bin] : part.bins) {
    KernelBin& to = sum->bins[place];
    to.lambda += bin.lambda;
    to.rows += bin.rows;
    if (to.moment.size() == 0) {
      to.moment = bin.moment;
    } else {
      to.moment += bin.moment;
    }
  }
  for (const auto& [frames, divergence] : part.divergence) {
    MatrixXd& to = sum->divergence[frames];
    if (to.size() == 0) {
      to = divergence;
    } else {
      to += divergence;
    }
  }
  sum->relaxation += part.relaxation;
  sum->runs += part.runs;
  sum->frames += part.frames;
}

}  // namespace

std::vector<KernelRun> KernelRuns(const KernelDesign& design,
                                  const std::vector<ObservedFlock>& flocks) {
  std::vector<KernelRun> runs;
  for (std::size_t f = 0; f < flocks.size(); ++f) {
    const ObservedFlock& flock = flocks[f];
    for (int animal = 0; animal < flock.animals(); ++animal) {
      const FrameSpan life = flock.Life(animal);
      for (int first = life.first; first <= life.last;) {
        int end = first;
        while (end <= life.last && flock.Measured(animal, end)) ++end;
        const int length = end - first;
        const int pieces = (length + design.segment - 1) / std::max(1, design.segment);
        for (int k = 0; k < pieces; ++k) {
          const int from = first + length * k / pieces, to = first + length * (k + 1) / pieces;
          if (to - from < ShortestRun(design.order)) continue;
          runs.push_back({f, animal, from, to - from});
        }
        first = std::max(end, first + 1);
      }
    }
  }
  return runs;
}

double KernelMoments::rows() const {
  double sum = 0;
  for (const auto& [place, bin] : bins) sum += bin.rows;
  return sum;
}

Eigen::VectorXd KernelMoments::RatesOf(const Eigen::VectorXd& coefficients) const {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(terms);
  for (const auto& [frames, sum] : divergence) weight += sum.rowwise().sum();
  const Eigen::VectorXd pulled = relaxation.selfadjointView<Eigen::Lower>() * coefficients;
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(terms);
  for (Index t = 0; t < terms; ++t) {
    if (weight[t] != 0) rates[t] = std::max(0.0, -pulled[t] / (dimensions * weight[t]));
  }
  return rates;
}

bool KernelTerms(const KernelDesign& design, const ObservedFlock& flock, const ObservedFlock& moved,
                 int animal, int frame, std::vector<Vec3d>* out, double* divergence) {
  const auto p = static_cast<std::size_t>(design.terms());
  out->assign(p, Vec3d{});
  if (divergence != nullptr) std::fill(divergence, divergence + p, 0.0);
  if (!flock.Has(animal, frame)) return false;
  const std::optional<Vec3d> v = Velocity(moved, animal, frame);
  if (design.has_alignment && !v) return false;
  const double dimensions =
      static_cast<double>(std::count(design.coordinates.begin(), design.coordinates.end(), true));
  const Vec3d x = flock.Position(animal, frame);
  const auto offset = static_cast<std::size_t>(design.alignment_offset());
  for (const int other : flock.Alive(frame)) {
    if (other == animal) continue;
    const Vec3d dx = flock.Position(other, frame) - x;
    const double r = Norm(dx);
    if (design.reach > 0 && r > design.reach) continue;
    if (design.has_attraction) {
      const SplineBasis::Local b = design.attraction.At(r);
      for (int k = 0; k <= design.attraction.degree(); ++k) {
        const auto at = static_cast<std::size_t>(b.first + k);
        const auto i = static_cast<std::size_t>(k);
        (*out)[at] += b.value[i] * dx;
        if (divergence != nullptr && design.order == 1) {
          divergence[at] -= b.slope[i] * r + dimensions * b.value[i];
        }
      }
    }
    if (!design.has_alignment) continue;
    const std::optional<Vec3d> velocity = Velocity(moved, other, frame);
    if (!velocity) return false;
    const Vec3d dv = *velocity - *v;
    const SplineBasis::Local b = design.alignment.At(r);
    for (int k = 0; k <= design.alignment.degree(); ++k) {
      const auto at = offset + static_cast<std::size_t>(b.first + k);
      const auto i = static_cast<std::size_t>(k);
      (*out)[at] += b.value[i] * dv;
      if (divergence != nullptr) divergence[at] -= dimensions * b.value[i];
    }
  }
  return true;
}

std::int64_t CountKernelRows(const KernelDesign& design, const std::vector<ObservedFlock>& flocks) {
  const std::int64_t coordinates =
      std::count(design.coordinates.begin(), design.coordinates.end(), true);
  std::int64_t rows = 0;
  for (const KernelRun& run : KernelRuns(design, flocks)) {
    rows += coordinates * (run.frames - design.order);
  }
  return rows;
}

KernelMoments GatherKernelMoments(const KernelDesign& design,
                                  const std::vector<ObservedFlock>& flocks,
                                  const std::vector<ObservedFlock>& moved, int threads) {
  Check(moved.size() == flocks.size(), "as many flocks moved as there are");
  Check(!flocks.empty(), "no runs of a flock");
  const std::vector<KernelRun> runs = KernelRuns(design, flocks);
  KernelMoments sum;
  sum.terms = design.terms();
  sum.dimensions =
      static_cast<int>(std::count(design.coordinates.begin(), design.coordinates.end(), true));
  sum.relaxation = MatrixXd::Zero(sum.terms, sum.terms);
  for (const KernelRun& run : runs) {
    if (sum.modes.contains(run.frames)) continue;
    sum.modes[run.frames] = MakeKernelModes(design.order, run.frames, flocks[run.flock].dt());
  }
  std::array<KernelMoments, kParts> parts;
  const auto count = static_cast<std::int64_t>(runs.size());
  ParallelFor(threads, 0, kParts, 1, [&](std::int64_t part, std::int64_t) {
    Gatherer gatherer(design, flocks, moved, sum.modes);
    for (std::int64_t k = count * part / kParts; k < count * (part + 1) / kParts; ++k) {
      gatherer.Add(runs[static_cast<std::size_t>(k)]);
    }
    parts[static_cast<std::size_t>(part)] = gatherer.Finish();
  });
  for (const KernelMoments& part : parts) AddTo(part, &sum);
  return sum;
}

}  // namespace flocklift
