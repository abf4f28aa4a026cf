// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The film's camera: where it stands, and which way it sees. Distortion is left out: what is drawn
// over the picture comes from the tracks, in pixels.

import type { CameraInfo } from './types';

// cam_from_world in a frame, rows [r r r t].
export function poseAt(camera: CameraInfo, frame: number): number[] {
  const moving = camera.poses.length / 12;
  if (moving > 0) {
    const k = Math.min(Math.max(frame - 1, 0), moving - 1);
    return camera.poses.slice(12 * k, 12 * k + 12);
  }
  return camera.pose ?? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
}

export function centreOf(pose: number[]): [number, number, number] {
  const t = [pose[3], pose[7], pose[11]];
  const at = (axis: number) =>
    -(pose[axis] * t[0] + pose[4 + axis] * t[1] + pose[8 + axis] * t[2]);
  return [at(0), at(1), at(2)];
}

// A camera-frame direction in the world.
export function toWorld(pose: number[], d: [number, number, number]): [number, number, number] {
  const at = (axis: number) =>
    pose[axis] * d[0] + pose[4 + axis] * d[1] + pose[8 + axis] * d[2];
  return [at(0), at(1), at(2)];
}

export function depthOf(pose: number[], x: number, y: number, z: number): number {
  return pose[8] * x + pose[9] * y + pose[10] * z + pose[11];
}
