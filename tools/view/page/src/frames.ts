// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Windows of rows as the server packs them (tools/view/frame_table.h).

export interface Rows {
  first: number;
  frames: number;
  start: Uint32Array;
  animal: Uint32Array;
}
export interface TrajectoryRows extends Rows {
  position: Float32Array;
  velocity: Float32Array;
  sd: Float32Array;
  orientation: Int16Array;
}
export interface BoxRows extends Rows {
  box: Float32Array;
  confidence: Float32Array;
}

const MAGIC = 0x574b4c46;

export function unpack(bytes: ArrayBuffer): TrajectoryRows | BoxRows {
  const header = new Uint32Array(bytes, 0, 8);
  if (header[0] !== MAGIC) throw new Error('the server sent no window of rows');
  const [, kind, first, frames, rows] = header;
  let at = 32;
  const u32 = (n: number) => new Uint32Array(bytes, (at += 4 * n) - 4 * n, n);
  const f32 = (n: number) => new Float32Array(bytes, (at += 4 * n) - 4 * n, n);
  const base: Rows = { first, frames, start: u32(frames + 1), animal: u32(rows) };
  if (kind === 1) return { ...base, box: f32(4 * rows), confidence: f32(rows) };
  return {
    ...base,
    position: f32(3 * rows),
    velocity: f32(3 * rows),
    sd: f32(rows),
    orientation: new Int16Array(bytes, at, 4 * rows),
  };
}

// Rows [begin, end) of a frame; empty where the window does not reach.
export function rowsOf(rows: Rows, frame: number): [number, number] {
  const k = frame - rows.first;
  return k < 0 || k >= rows.frames ? [0, 0] : [rows.start[k], rows.start[k + 1]];
}

// The row of an animal in a frame, -1 when it is not there.
export function rowOf(rows: Rows, frame: number, animal: number): number {
  const [begin, end] = rowsOf(rows, frame);
  for (let low = begin, high = end; low < high; ) {
    const middle = (low + high) >> 1;
    if (rows.animal[middle] === animal) return middle;
    if (rows.animal[middle] < animal) low = middle + 1;
    else high = middle;
  }
  return -1;
}
