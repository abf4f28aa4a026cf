// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Do boxes follow the bodies in them? Two models of what is seen, both priors of the flock's
// ratio, log trunk and log up (cost_functions/size.h):
//   body   a bird in flight: the ratio of box_of_body.h, trunk and up of wings and a trunk
//   stiff  as large from every side: a ball, a drone, a detector with boxes of one form. Trunk and
//          up are 1; the wingspan is the longer side, to 15 %.
// The data say which by their evidence. With the posterior N(m, P) found under the prior
// N(m_0, P_0), the likelihood is their ratio, a Gaussian of information L = 1/P - 1/P_0 and
// h = m/P - m_0/P_0, and under another prior N(n, Q) the evidence is, but for what is common,
//   log Z = 1/2 (g' A^-1 g - n' Q^-1 n - log |A Q|),  A = L + 1/Q,  g = h + n/Q.
// (MacKay, Bayesian interpolation, Neural Computation, 1992.) Headings, sizes and the prior of the
// speed are all in it. The spread s of the boxes' form (box_form.h) is evidence of its own: of
// silhouettes log s ~ N(log 0.25, 0.7); of stiff boxes s is what measuring adds, anything from 0.01
// to 0.1 with the logarithm uniform. Less counts as 0.01: a form that never changes is evidence
// too, but not more than what sizes say of headings can outweigh. Each scalar's prior is then the
// mixture of the two, as mean and sd.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_SIZE_MODEL_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_SIZE_MODEL_H_

#include <Eigen/Core>

#include "reconstruct/initialize/box_form.h"
#include "reconstruct/knowledge.h"

namespace flocklift::internal {

struct SizeModel {
  Uncertain ratio, log_trunk, log_up;
};

SizeModel StiffSizes(const BoxForm& form);

// What the data say of the three, from the posterior under the prior that was used.
struct SizeLikelihood {
  Eigen::Matrix3d information;
  Eigen::Vector3d pull;  // information times mean

  SizeLikelihood(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance,
                 const SizeModel& prior);

  double LogEvidence(const SizeModel& model) const;
};

// That boxes are stiff; beforehand 1 in 10.
double ProbabilityOfStiff(const SizeLikelihood& likelihood, const BoxForm& form,
                          const SizeModel& body, const SizeModel& stiff);

SizeModel Mixture(double stiff_probability, const SizeModel& body, const SizeModel& stiff);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_SIZE_MODEL_H_
