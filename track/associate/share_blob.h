// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One blob, several animals: where each of them is. The blob's pixels are a mixture of Gaussians
// whose shapes and weights are those that each animal had while it was alone, and whose means start
// at, and are held near, the predictions (expectation-maximisation, maximum a posteriori):
//   g_pk ~ m_k N(x_p; mu_k, Sigma_k),   xbar_k = sum_p w_p g_pk x_p / sum_p w_p g_pk,
//   mu_k = (P_k xbar_k + R_k prediction_k) / (P_k + R_k),
// where R_k grows with how much of the animal is also explained by others.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_SHARE_BLOB_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_SHARE_BLOB_H_

#include <span>
#include <vector>

#include "track/detect/blob.h"

namespace flocklift {

// What is known of one animal before the blob is looked at.
struct Expectation {
  Vec2d position;       // predicted [px]
  double variance = 1;  // of the prediction, per axis [px^2]
  double noise = 0.1;   // variance of a measurement while it is alone [px^2]
  double mass = 1;
  Moments moments;
};

// Its share of the blob.
struct BlobShare {
  Vec2d position;        // measured [px]
  double variance = 1;   // R_k [px^2]
  double ambiguity = 0;  // share of its pixels that others explain as well, in [0, 1]
};

std::vector<BlobShare> ShareBlob(std::span<const BlobPixel> pixels,
                                 std::span<const Expectation> animals);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_SHARE_BLOB_H_
