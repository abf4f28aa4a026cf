// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Preconditioned conjugate gradients for M x = b, M symmetric and positive definite and known only
// by what it does to a vector; several right-hand sides side by side, each with steps of its own.
// Every iteration lowers  q(x) = x^T M x / 2 - b^T x;  it ends where the last one lowered q by less
// than a share of what all did (Nash and Sofer, "Assessing a search direction within a
// truncated-Newton method", 1990).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_CONJUGATE_GRADIENTS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_CONJUGATE_GRADIENTS_H_

#include <Eigen/Core>

namespace flocklift::internal {

struct GradientStop {
  double share = 1e-3;  // of q's fall, in one iteration
  int most = 200;       // iterations
};

// multiply(x, &y): y = M x; precondition(&x): x = P^-1 x with P near M. Returns x from 0 on.
template <typename Vectors, typename Multiply, typename Precondition>
Vectors ConjugateGradients(const Vectors& b, const GradientStop& stop, const Multiply& multiply,
                           const Precondition& precondition, int* iterations = nullptr) {
  using Row = Eigen::Array<double, 1, Vectors::ColsAtCompileTime>;
  const auto dot = [](const Vectors& u, const Vectors& v) -> Row {
    return u.cwiseProduct(v).colwise().sum().array();
  };
  Vectors x = Vectors::Zero(b.rows(), b.cols()), r = b, z = b, y = x;
  precondition(&z);
  Vectors p = z;
  Row rz = dot(r, z), fallen = Row::Zero(1, b.cols());
  for (int iteration = 0; iteration < stop.most; ++iteration) {
    multiply(p, &y);
    const Row curved = dot(p, y);
    // One that is solved stands still.
    const Row step = (curved > 0 && rz > 0).select(rz / curved, 0.0);
    x += p * step.matrix().asDiagonal();
    r -= y * step.matrix().asDiagonal();
    const Row fall = 0.5 * step * rz;
    fallen += fall;
    if (iterations != nullptr) ++*iterations;
    if (!(fall > stop.share * fallen).any()) break;
    z = r;
    precondition(&z);
    const Row next = dot(r, z);
    const Row turn = (rz > 0).select(next / rz, 0.0);
    p = z + p * turn.matrix().asDiagonal();
    rz = next;
  }
  return x;
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_CONJUGATE_GRADIENTS_H_
