// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The last half minute of a running scene: how ordered it is, how fast, how far from the point that
// attracts it.

import type { Look } from './live';

const KEPT = 900;

function measure(look: Look): (number | null)[] {
  const n = Math.max(look.agents, 1);
  let speed = 0;
  let distance = 0;
  const heading = [0, 0, 0];
  const centre = [0, 0, 0];
  const goal = look.goals.length > 0 ? look.goals.subarray(look.goals.length - 3) : null;
  for (let k = 0; k < look.agents; k++) {
    const v = look.velocity.subarray(3 * k, 3 * k + 3);
    const p = look.position.subarray(3 * k, 3 * k + 3);
    const length = Math.hypot(v[0], v[1], v[2]);
    speed += length * look.unit;
    for (let axis = 0; axis < 3; axis++) {
      if (length > 0) heading[axis] += v[axis] / length / n;
      centre[axis] += p[axis] / n;
    }
    if (goal) distance += Math.hypot(p[0] - goal[0], p[1] - goal[1], p[2] - goal[2]);
  }
  let spread = 0;
  for (let k = 0; k < look.agents; k++) {
    for (let axis = 0; axis < 3; axis++) spread += (look.position[3 * k + axis] - centre[axis]) ** 2;
  }
  return [Math.hypot(...heading), speed / n, Math.sqrt(spread / n), goal ? distance / n : null];
}

export class LiveSeries {
  readonly columns: (number | null)[][] = [[], [], [], [], []];
  private count = 0;
  listener: (() => void) | null = null;

  take(look: Look): void {
    if (this.count++ % 2 !== 0) return; // 30 a second are enough
    const times = this.columns[0] as number[];
    if (times.length > 0 && look.time <= times[times.length - 1]) {
      if (look.time === times[times.length - 1]) return;
      this.columns.forEach((column) => (column.length = 0)); // a reset
    }
    [look.time, ...measure(look)].forEach((value, k) => this.columns[k].push(value));
    if (times.length > KEPT) this.columns.forEach((column) => column.shift());
    this.listener?.();
  }
}
