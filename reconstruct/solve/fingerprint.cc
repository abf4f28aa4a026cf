// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/fingerprint.h"

#include "simulate/core/build_id.h"

namespace flocklift::internal {

std::uint64_t FingerprintOf(const BatchOptions& options, const Knowledge& knowledge,
                            const Segments& segments, double fps, std::uint64_t method) {
  Hash hash;
  hash.Add(std::string_view(ProgramIdentity()));
  hash.Add(method);
  hash.Add(fps);
  BatchOptions described = options;
  Describe(hash, described);
  hash.Add(knowledge.speed);
  hash.Add(knowledge.wingspan);
  hash.Add(knowledge.near);
  hash.Add(knowledge.far);
  hash.Add(knowledge.use_size);
  hash.Add(knowledge.up_in_cam);
  for (const Anchor& anchor : knowledge.anchors) {
    hash.Add(anchor.frame);
    hash.Add(anchor.id);
    hash.Add(anchor.position);
    hash.Add(anchor.sd);
  }
  hash.Add(segments.form.log_diagonal);
  hash.Add(segments.form.sd);
  for (const Vec3d& place : segments.camera_places) hash.Add(place);
  for (const Segment& segment : segments.segments) {
    hash.Add(segment.id);
    for (const View& view : segment.views) {
      for (const double x : {view.time, view.ray.x, view.ray.y, view.ray_sd}) hash.Add(x);
      for (const double x : view.view_from_ref.rotation.m) hash.Add(x);
      hash.Add(view.view_from_ref.translation);
    }
    for (const Sighting& s : segment.sightings) {
      hash.Add(s.frame);
      hash.Add(s.ray.x);
      hash.Add(s.ray.y);
      hash.Add(s.ray_sd);
      hash.Add(s.log_size);
      hash.Add(s.ellipticity);
    }
  }
  return hash.value();
}

}  // namespace flocklift::internal
