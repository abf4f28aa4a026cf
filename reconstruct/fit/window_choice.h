// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The window that accelerations of a reconstruction are taken over, chosen by how the model then
// flies. The noise of positions (ChooseWindow of motion_rows.h) says too little there: depth errors
// are slow, and whether the memory of what the model leaves over swallows a slow term, such as the
// pull that makes a flock wheel, depends on the window. So the model is fitted over several, flown
// on without noise from states of the reconstruction, and compared with where that goes:
//   E^2 = mean |x_i flown (t + lead) - x_i (t + lead)|^2     over animals and a few starts t
// Another window than the noise's is taken when its E^2 is clearly lower. It is one of five numbers
// that the same flights choose: too few to be fitted to them. Metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_WINDOW_CHOICE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_WINDOW_CHOICE_H_

#include <cstdint>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/radius_choice.h"
#include "reconstruct/fit/term_surroundings.h"

namespace flocklift::internal {

// Root mean squares [m]; of no flight both are 0.
struct FlownErrors {
  double model = 0, straight_on = 0;
};

// Flights start evenly over the time. `lead` [s] is at most a third of it. Velocities are those of
// the trajectories, or differences where they have none; everybody's own speed is the mean of them.
// `around`: the wind that the terms of a scene feel.
FlownErrors FlyOn(const Parameters& parameters, const Trajectories& trajectories, double fps,
                  int substeps, double lead, const TermSurroundings& around = {});

// Of the fit with the radii and the noise of `choice`. 0 where there is no choice: the fit is not
// by errors in variables.
int ChooseWindowByFlight(const FitOptions& options, const RadiusChoice& choice,
                         const Trajectories& trajectories, double fps, std::uint64_t seed,
                         int threads);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_WINDOW_CHOICE_H_
