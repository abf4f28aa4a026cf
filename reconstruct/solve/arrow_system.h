// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normal equations of many paths that share a few unknowns. One path has n banded unknowns (its
// control points, three scalars each, interleaved) and a border of k: `own` scalars of its own
// first, then the flock's:
//   [ A    U ] [dx]   [ -g_x ]      A: n x n, half-bandwidth 11 (four control points)
//   [ U^T  D ] [db] = [ -g_b ]      U: n x k,  D: k x k
// Eliminating the band costs O(n (12^2 + 12 k + k^2)) at most, linear in the length of the path:
// what the flock has in common changes over time, and unknowns that a path has not met yet cost
// nothing. The flock's part is the sum of all paths' Schur complements. (Golub and Van Loan, Matrix
// Computations, 4.3.5; the selected inverse is the recursion of Takahashi, Fagan and Chin, 1973.)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_ARROW_SYSTEM_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_ARROW_SYSTEM_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace flocklift::internal {

// One whitened residual and its derivatives: by 12 neighbouring unknowns of the band, from
// `first`, and by a few of the border.
struct ResidualRow {
  int first = 0;
  double residual = 0;
  std::array<double, 12> path{};
  std::array<std::pair<int, double>, 10> border;
  int border_count = 0;

  void AddBorder(int index, double derivative) {
    for (int a = 0; a < border_count; ++a) {
      if (border[a].first == index) {
        border[a].second += derivative;
        return;
      }
    }
    border[border_count++] = {index, derivative};
  }
};

// Vectors side by side, for as many right-hand sides.
template <int Count>
using Columns =
    Eigen::Matrix<double, Eigen::Dynamic, Count, Count == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

class ArrowSystem {
 public:
  static constexpr int kBand = 12;  // stored entries of a row: columns i - 11 .. i

  ArrowSystem(int n, int own, int shared);

  int n() const { return n_; }
  int border() const { return k_; }
  int own() const { return own_; }
  const Eigen::MatrixXd& corner() const { return corner_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }  // n + k
  double Diagonal(int i) const;                                  // of the path's unknowns

  void SetZero();
  // A system that asks for no step at all and says nothing of the flock.
  void SetIdentity();
  // Adds weight * (J^T J) and the gradient weight * J^T r. Entries of `path` past n are ignored.
  void Add(const ResidualRow& row, double weight = 1);
  // Adds three residuals at once, each with its weight: derivatives by the 12 from `first`, by one
  // unknown of its own and by some of the flock's.
  struct Rows {
    int first = 0;
    Eigen::Vector3d residual;
    Eigen::Matrix<double, 3, kBand> path;
    int own = 0;
    Eigen::Vector3d by_own;
    struct Run {  // of neighbouring unknowns of the flock, from `first`
      static constexpr int kMost = 16;
      int first = 0;
      Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMost> by{3, 0};
    };
    std::array<Run, 2> by_shared{};
  };
  void Add(const Rows& rows, const Eigen::Vector3d& weight);
  // Adds what many residuals of the same 12 unknowns come to, their J^T W J and J^T W r.
  using Square = Eigen::Matrix<double, kBand, kBand>;
  using Pull = Eigen::Matrix<double, kBand, 1>;
  void Add(int first, const Square& square, const Pull& pull);

  // What Reduce and GatherBorder make holds until the next SetZero or Add.
  //
  // Factorises the band and the path's own scalars, and gives the flock's share: matrix += S,
  // gradient += g of the reduced system. False when the system is not positive definite.
  // Damping multiplies the diagonal by 1 + damping (Marquardt), but adds damping * kDepthMetric to
  // every third unknown of the band, the log depths (Levenberg): smoothness makes their diagonals
  // huge, and a step of all of them together, the scale of the scene, must stay free.
  static constexpr double kDepthMetric = 1e4;
  bool Reduce(double damping, Eigen::MatrixXd* shared_matrix, Eigen::VectorXd* shared_gradient);

  // After Reduce: the step of the path (n values, then its own scalars) for a step of the flock's
  // unknowns, and what the quadratic model of this path then falls by (own share).
  Eigen::VectorXd BackSubstitute(const Eigen::VectorXd& shared_step) const;

  // After the last Add, before Multiply.
  void GatherBorder();
  // Adds the matrix times x: x and y are the path's unknowns and its own scalars, `shared` and
  // `out` the flock's. (Instantiated for the counts of coupled_flock.h.)
  template <int Count>
  void Multiply(const Eigen::Ref<const Columns<Count>>& x, const Columns<Count>& shared,
                Eigen::Ref<Columns<Count>> y, Columns<Count>* out) const;
  // After Reduce: eliminates the path and its own scalars from other right-hand sides in place and
  // adds the flock's share to `shared`; and with the flock's solution, solves for them.
  template <int Count>
  void Eliminate(Eigen::Ref<Columns<Count>> x, Columns<Count>* shared) const;
  template <int Count>
  void Substitute(const Columns<Count>& shared, Eigen::Ref<Columns<Count>> x) const;

  // After Reduce(0): covariances, given that of the flock's unknowns.
  struct Posterior {
    std::vector<double> band;  // n x 12: of unknowns i and i - 11 .. i, column 11 the variance
    Eigen::MatrixXd border;    // k x k
    Eigen::MatrixXd path_to_border;  // n x k: E, with x's covariance A^-1 + E border E^T
  };
  Posterior Covariance(const Eigen::MatrixXd& shared_covariance) const;

  // Of the row's value J (x, b) under the posterior.
  double VarianceOf(const Posterior& posterior, const ResidualRow& row) const;

  // Of a mean over the path: variance of weights^T x that does not come from the flock's unknowns,
  // and its sensitivity to them.
  std::pair<double, Eigen::VectorXd> Functional(const Eigen::VectorXd& weights) const;

 private:
  // Place of entry (i, j) of a stored lower band, i - 11 <= j <= i.
  static std::size_t At(int i, int j) {
    return static_cast<std::size_t>(i) * kBand + static_cast<std::size_t>(j - i + kBand - 1);
  }
  bool FactoriseBand(double damping);
  void Meet(int border, int first);  // the 12 unknowns of the path from `first` on
  void SortBorder();                 // by when unknowns are met
  // A border unknown that the path meets late has no share of what is eliminated before. Sorted,
  // those met so far come first: calls visit(i, columns, unknowns) for `columns` of the path from i
  // on and the number of unknowns met by their end.
  static constexpr int kColumns = 48;  // of a block
  template <typename Visit>
  void ForEachBlock(const Visit& visit) const {
    int met = 0;
    for (int first = 0; first < n_; first += kColumns) {
      const int columns = std::min(kColumns, n_ - first);
      while (met < k_ && met_[order_[met]] < first + columns) ++met;
      visit(first, columns, met);
    }
  }
  // L^-1 U and L^-1 g; and, sorted, of both what is taken off the border's: the former's square and
  // its product with the latter.
  void ReduceBorder(Eigen::MatrixXd* squares, Eigen::VectorXd* pulls);
  // L^-1 U, transposed, times the path's unknowns; and taken off x, times the border's.
  template <int Count>
  Columns<Count> ReducedTimes(const Eigen::Ref<const Columns<Count>>& x) const;
  template <int Count>
  void SubtractReduced(const Columns<Count>& border, Eigen::Ref<Columns<Count>> x) const;
  void SolveBandInPlace(Eigen::Ref<Eigen::VectorXd> x) const;

  int n_, own_, k_;
  std::vector<double> band_;  // n x 12 lower band of A
  Eigen::MatrixXd border_;    // k x n: U^T
  struct Piece {              // of U^T: some columns, and the border unknowns that meet them
    int first = 0;
    std::vector<int> border;
    Eigen::MatrixXd values;
  };
  std::vector<Piece> pieces_;
  Eigen::MatrixXd corner_;          // k x k: D
  Eigen::VectorXd gradient_;        // n + k
  std::vector<double> factor_;      // n x 12: Cholesky factor of A
  std::vector<int> met_, left_;     // unknowns of the path that a border unknown meets: first, end
  std::vector<int> order_;          // of the border, by met_
  Eigen::MatrixXd reduced_border_;  // k x n: (L^-1 U)^T, sorted; only what is met so far is set
  Eigen::VectorXd reduced_gradient_;  // n: L^-1 g_x
  Eigen::MatrixXd own_factor_;        // own x own: Cholesky factor of the own Schur complement
  Eigen::MatrixXd own_to_shared_;     // own x shared: Schur complement's block
  Eigen::VectorXd own_gradient_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_ARROW_SYSTEM_H_
