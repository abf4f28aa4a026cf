// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Windows of rows as the server packs them (tools/view/frame_table.h), and a cache of them: asking
// for a frame that is not there yet fetches its window and those that will be needed next.

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

export type Fetch = (first: number, last: number) => Promise<ArrayBuffer>;

export class FrameCache<T extends Rows> {
  private windows = new Map<number, T>(); // by number; in the order of their last use
  private pending = new Set<number>();
  private generation = 0;

  constructor(
    private length: number, // frames of a window
    private fetchWindow: Fetch,
    private loaded: () => void,
    private failed: (error: unknown) => void,
    private most = 24,
  ) {}

  // The window of a frame, if it is here; else it is on its way.
  at(frame: number): T | undefined {
    const number = Math.floor(frame / this.length);
    const found = this.windows.get(number);
    if (!found) {
      this.fetch(number);
      return undefined;
    }
    this.windows.delete(number);
    this.windows.set(number, found);
    return found;
  }
  // As at(), and gets what comes after it ready.
  ahead(frame: number): T | undefined {
    const found = this.at(frame);
    const next = Math.floor(frame / this.length) + 1;
    if (!this.windows.has(next)) this.fetch(next);
    return found;
  }
  // What was fetched is of before; it stays in sight until the new has come.
  renew(): void {
    this.generation++;
    this.pending.clear();
    const old = [...this.windows.keys()];
    const wanted = old.slice(-3);
    for (const number of old) if (!wanted.includes(number)) this.windows.delete(number);
    for (const number of wanted) this.fetch(number);
  }

  private fetch(number: number): void {
    if (this.pending.has(number) || number < 0) return;
    this.pending.add(number);
    const generation = this.generation;
    const first = number * this.length;
    this.fetchWindow(first, first + this.length - 1)
      .then((bytes) => {
        if (generation !== this.generation) return;
        this.windows.set(number, unpack(bytes) as Rows as T);
        this.pending.delete(number);
        while (this.windows.size > this.most) {
          this.windows.delete(this.windows.keys().next().value as number);
        }
        this.loaded();
      })
      .catch((error: unknown) => {
        this.pending.delete(number);
        this.failed(error);
      });
  }
}
