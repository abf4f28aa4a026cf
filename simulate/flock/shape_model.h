// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The shape-constrained swarm of Q. Chen, G. Luo, Y. Tong, X. Jin, Z. Deng, "Shape-constrained
// flying insects animation", CAVW 2019 (equations.md, section 6):
//   a = alpha (F_int + F_cur) + (1 - alpha) (F_con + F_dis)
// F_int: the three zones of BSwarm; F_cur: curl noise; F_con: the shape force, which spreads those
// who share the shape; F_dis: the pull to the animal's own sample of the shape. The published radii
// reach everybody, so neighbours are capped, which is ours: zones end at a range that the motion
// widens and narrows until an animal has about `neighbours` of them, by default 8, of the order of
// the 6 or 7 that starlings heed (Ballerini et al. 2008). What the paper claims of error and motion
// holds with the cap (tests/simulate/flock/shape_motion_test.cc). 0 takes the zones as they are.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SHAPE_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SHAPE_MODEL_H_

#include "simulate/core/options.h"

namespace flocklift {

// Defaults of Chen et al. 2019, table 1; what it leaves open: w_con, dis_range, obstacle_range,
// d_min, neighbours.
struct ShapeParameters {
  double alpha = 0.7;
  double r_rep = 0.3, r_ali = 10, r_att = 30;
  double w_rep = 0.2, w_ali = 3, w_att = 13;
  double neighbours = 8;
  double gain = 0.125, scale = 0.32;
  double w_con = 1, k = 2, omega = 0.9;
  double w_dis = 4, dis_range = 1;
  double s_max = 0.75, drag = 0;
  double obstacle_range = 1;
  double d_min = 0.05;
};

template <typename Visitor>
void Describe(Visitor& visit, ShapeParameters& p) {
  visit("alpha", p.alpha, {.low = 0, .high = 1}, "",
        "weight of the swarm's own forces; 1 - alpha is that of the shape");
  visit("r_rep", p.r_rep, {.low = 0}, "m", "zone of repulsion: up to here");
  visit("r_ali", p.r_ali, {.low = 0}, "m", "zone of alignment: from r_rep up to here");
  visit("r_att", p.r_att, {.low = 0}, "m", "zone of attraction: from r_ali up to here");
  visit("w_rep", p.w_rep, {.low = 0}, "m/s^2", "strength of repulsion");
  visit("w_ali", p.w_ali, {.low = 0}, "m/s^2", "strength of alignment");
  visit("w_att", p.w_att, {.low = 0}, "m/s^2", "strength of attraction");
  visit("neighbours", p.neighbours, {.low = 0, .high = 1e6}, "",
        "zones end where an animal has about so many neighbours; 0: at their radii, as published");
  visit("gain", p.gain, {.low = 0}, "m^2/s^2", "eta, strength of the curl noise's potential");
  visit("scale", p.scale, {.low = 1e-6}, "m", "rho, size of the curl noise's cells");
  visit("w_con", p.w_con, {.low = 0}, "m/s^2", "strength of the force that spreads over the shape");
  visit("k", p.k, {.low = 0, .high = 100}, "", "its reach, in mean distances of samples");
  visit("omega", p.omega, {.low = 1e-6, .high = 100}, "", "its fall-off, likewise");
  visit("w_dis", p.w_dis, {.low = 0}, "m/s^2", "strength of the pull to the own sample");
  visit("dis_range", p.dis_range, {.low = 1e-6}, "m",
        "D, farther than this from the sample the pull is constant");
  visit("s_max", p.s_max, {.low = 0}, "m/s", "highest speed; on a path: relative to it");
  visit("drag", p.drag, {.low = 0}, "1/s", "viscous drag, likewise");
  visit("obstacle_range", p.obstacle_range, {.low = 1e-6}, "m",
        "L, nearer than this an obstacle takes away what flies into it");
  visit("d_min", p.d_min, {.low = 0}, "m", "animals nearer than this are pushed apart; 0: not");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_MODEL_H_
