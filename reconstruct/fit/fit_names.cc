// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the command line and the messages call the methods and outcomes of a fit.

#include "reconstruct/fit/fit.h"
#include "simulate/core/check.h"

namespace flocklift {

std::string StatusText(FitStatus status) {
  switch (status) {
    case FitStatus::kOk:
      return "fitted";
    case FitStatus::kTooFewAnimals:
      return "there are no animals to fit";
    case FitStatus::kTooFewFrames:
      return "too few frames: no animal has a run of frames that is long enough, or they span too "
             "little time";
    case FitStatus::kTooFewRows:
      return "too few animals and frames for so many weights: free fewer";
  }
  return "";
}

std::string NameOf(FitMethod method) {
  switch (method) {
    case FitMethod::kAuto:
      return "auto";
    case FitMethod::kStateSpace:
      return "state-space";
    case FitMethod::kErrorsInVariables:
      return "errors-in-variables";
    case FitMethod::kDifferences:
      return "differences";
    case FitMethod::kNoiseField:
      return "noise-field";
    case FitMethod::kStatistics:
      return "statistics";
  }
  return "";
}

FitMethod FitMethodOf(const std::string& name) {
  for (const FitMethod method :
       {FitMethod::kAuto, FitMethod::kStateSpace, FitMethod::kErrorsInVariables,
        FitMethod::kDifferences, FitMethod::kNoiseField, FitMethod::kStatistics}) {
    if (NameOf(method) == name) return method;
  }
  Check(false, "--method " + name +
                   " is none of auto, state-space, errors-in-variables, differences, noise-field "
                   "and statistics");
  return FitMethod::kAuto;
}

SimulatedSearch SimulatedSearchOf(const std::string& name) {
  if (name == "bobyqa") return SimulatedSearch::kBobyqa;
  if (name == "crs") return SimulatedSearch::kCrs;
  Check(name == "isres", "--search " + name + " is none of bobyqa, crs and isres");
  return SimulatedSearch::kIsres;
}

}  // namespace flocklift
