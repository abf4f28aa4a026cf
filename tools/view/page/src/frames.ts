// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Windows of rows as the server packs them (tools/view/frame_table.h), and a cache of them: asking
// for a frame that is not there yet fetches its window and those that will be needed next. Of a
// large flock a window takes a while: then the frame comes by itself at first, and its window when
// the person stays near it, one after the other, so that a frame never waits for many.

import { Refusal } from './api';

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

const LARGE = 64; // windows of fewer frames are those of a large flock
const REST = 200; // ms near a place before its windows are fetched

export class FrameCache<T extends Rows> {
  private windows = new Map<number, T>(); // by number; in the order of their last use
  private pending = new Set<number>();
  private refused = new Map<number, unknown>(); // windows that are damaged
  private stale = new Set<number>(); // windows of before, in sight until the new have come
  private generation = 0;
  private glimpse: T | undefined; // one frame
  private glimpsing = false;
  private wanted = new Set<number>(); // once the person stays
  private place = -1; // the window of the frame last asked for
  private timer = 0;

  constructor(
    private length: number, // frames of a window
    private fetchWindow: Fetch,
    private loaded: () => void,
    private failed: (error: unknown) => void,
    private most = 24,
  ) {}

  // The rows of a frame and more, if they are here; else they are on their way.
  at(frame: number): T | undefined {
    const number = Math.floor(frame / this.length);
    if (number !== this.place) {
      this.place = number;
      this.wanted.clear();
      clearTimeout(this.timer);
      this.timer = 0;
    }
    const found = this.near(frame);
    if (found) return found;
    if (this.refused.has(number)) this.failed(this.refused.get(number));
    else if (this.length < LARGE) this.look(frame);
    const { glimpse } = this;
    return glimpse && glimpse.first === frame ? glimpse : undefined;
  }
  // The same of a frame beside the one that matters.
  near(frame: number): T | undefined {
    const number = Math.floor(frame / this.length);
    const found = this.windows.get(number);
    if (!found) {
      this.want(number);
      return undefined;
    }
    this.windows.delete(number);
    this.windows.set(number, found);
    return found;
  }
  // Whether the rows of a frame are here, and none of before.
  isNew(frame: number): boolean {
    const number = Math.floor(frame / this.length);
    return this.windows.has(number) && !this.stale.has(number);
  }
  // As at(), and gets what comes after it ready.
  ahead(frame: number): T | undefined {
    const found = this.at(frame);
    this.want(Math.floor(frame / this.length) + 1);
    return found;
  }
  // What was fetched is of before; it stays in sight until the new has come.
  renew(): void {
    this.generation++;
    this.pending.clear();
    this.refused.clear();
    this.glimpse = undefined;
    const old = [...this.windows.keys()];
    const wanted = old.slice(-3);
    for (const number of old) if (!wanted.includes(number)) this.windows.delete(number);
    this.stale = new Set(wanted);
    for (const number of wanted) this.fetch(number);
  }

  private want(number: number): void {
    if (number < 0 || this.windows.has(number) || this.pending.has(number) || this.refused.has(number)) return;
    if (this.length >= LARGE) return this.fetch(number);
    this.wanted.add(number);
    // While it plays, the next window is fetched in time; after a jump, when the person stays.
    if (this.windows.has(this.place)) this.fetchWanted();
    else this.timer ||= window.setTimeout(() => this.fetchWanted(), REST);
  }

  // The window of the place, then those after it, then those before it.
  private fetchWanted(): void {
    this.timer = 0;
    if (this.pending.size > 0) return; // goes on when it has come
    const order = (n: number) => (n >= this.place ? n - this.place : 1000 + this.place - n);
    const missing = [this.place, ...this.wanted].filter((n) => !this.windows.has(n) && !this.refused.has(n));
    const [next] = missing.sort((a, b) => order(a) - order(b));
    if (next === undefined) return;
    this.wanted.delete(next);
    this.fetch(next);
  }

  // One frame at a time, the latest that is asked for.
  private look(frame: number): void {
    if (this.glimpsing || this.glimpse?.first === frame) return;
    this.glimpsing = true;
    const generation = this.generation;
    this.fetchWindow(frame, frame)
      .then((bytes) => {
        if (generation === this.generation) this.glimpse = unpack(bytes) as Rows as T;
      })
      .catch((error: unknown) => this.failed(error))
      .finally(() => {
        this.glimpsing = false;
        this.loaded();
      });
  }

  private fetch(number: number): void {
    if (this.pending.has(number) || this.windows.has(number) && !this.stale.has(number)) return;
    if (number < 0) return;
    this.pending.add(number);
    const generation = this.generation;
    const first = number * this.length;
    this.fetchWindow(first, first + this.length - 1)
      .then((bytes) => {
        if (generation !== this.generation) return;
        this.windows.set(number, unpack(bytes) as Rows as T);
        this.stale.delete(number);
        this.pending.delete(number);
        while (this.windows.size > this.most) {
          this.windows.delete(this.windows.keys().next().value as number);
        }
        this.loaded();
        if (this.length < LARGE && this.windows.has(this.place)) this.fetchWanted();
      })
      .catch((error: unknown) => {
        if (generation !== this.generation) return;
        this.pending.delete(number);
        if (error instanceof Refusal) this.refused.set(number, error);
        this.failed(error);
      });
  }
}
