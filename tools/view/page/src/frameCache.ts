// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Windows of rows that are here or on their way: asking for a frame that is not there yet fetches
// its window and those that will be needed next. Of a large flock a window takes a while: then the
// frame comes by itself at first, and its window, a short one, when the person stays near it, one
// after the other of all caches, so that a frame never waits for many.

import { Refusal } from './api';
import { unpack, type Rows } from './frames';

export type Fetch = (first: number, last: number, signal: AbortSignal) => Promise<ArrayBuffer>;

const REST = 200; // ms near a place before its windows are fetched
const AT_ONCE = 2; // frames by themselves

// How many frames a window has, and how many of what was fetched are kept.
export interface Extent {
  length: number;
  windows: number;
  glimpses: number; // 0: no frame comes by itself
}

const ROWS_OF_WINDOW = 20000;
const ROWS_OF_SHORT_ONE = 8000; // of a large flock
const ROWS_KEPT = 480000;
const LARGE = 300; // animals

export function extentOf(animals: number): Extent {
  const n = Math.max(animals, 1);
  if (n <= LARGE) {
    return { length: Math.min(Math.floor(ROWS_OF_WINDOW / n), 256), windows: 24, glimpses: 0 };
  }
  const length = Math.max(Math.floor(ROWS_OF_SHORT_ONE / n), 2);
  const windows = Math.max(Math.floor(ROWS_KEPT / (n * length)), 24);
  return { length, windows, glimpses: Math.max(Math.floor(ROWS_KEPT / n), 8) };
}

// Lets one go at a time: who finds it taken is called when it is free.
export class Lane {
  private taken = false;
  private waiting = new Set<() => void>();

  take(later: () => void): boolean {
    if (this.taken) {
      this.waiting.add(later);
      return false;
    }
    this.taken = true;
    return true;
  }
  leave(): void {
    this.taken = false;
    const all = [...this.waiting];
    this.waiting.clear();
    for (const later of all) later();
  }
}

export class FrameCache<T extends Rows> {
  private windows = new Map<number, T>(); // by number; in the order of their last use
  private pending = new Map<number, AbortController>();
  private refused = new Map<number, unknown>(); // windows that are damaged
  private stale = new Set<number>(); // windows of before, in sight until the new have come
  private generation = 0;
  private glimpses = new Map<number, T>(); // frames by themselves, likewise
  private glimpsing = new Set<number>();
  private wanted = new Set<number>(); // once the person stays
  private frame = -1; // last asked for, and its window
  private place = -1;
  private timer = 0;

  constructor(
    private extent: Extent,
    private lane: Lane,
    private fetchWindow: Fetch,
    private loaded: () => void, // what was asked for
    private completed: () => void, // what goes with it, where it is in sight already
    private failed: (error: unknown) => void,
  ) {}

  // The rows of a frame and more, if they are here; else they are on their way.
  at(frame: number): T | undefined {
    const number = this.numberOf(frame);
    this.frame = frame;
    if (Math.abs(number - this.place) > 1) this.leave();
    this.place = number;
    const found = this.near(frame);
    if (found) return found;
    if (this.refused.has(number)) this.failed(this.refused.get(number));
    const glimpse = this.glimpses.get(frame);
    return glimpse || !this.isLarge ? glimpse : this.look(frame);
  }
  // The same of a frame beside the one that matters.
  near(frame: number): T | undefined {
    const number = this.numberOf(frame);
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
    const number = this.numberOf(frame);
    return this.windows.has(number) && !this.stale.has(number);
  }
  // As at(), and gets what comes after it ready.
  ahead(frame: number): T | undefined {
    const found = this.at(frame);
    this.want(this.numberOf(frame) + 1);
    if (this.isLarge) this.want(this.numberOf(frame) + 2);
    return found;
  }
  // A frame by itself that nobody has to fetch.
  give(frame: number, bytes: ArrayBuffer): void {
    this.keep(this.glimpses, frame, bytes, 1);
  }
  // What was fetched is of before; it stays in sight until the new has come.
  renew(): void {
    this.generation++;
    this.pending.clear();
    this.refused.clear();
    this.glimpses.clear();
    this.glimpsing.clear();
    const old = [...this.windows.keys()];
    const wanted = old.slice(-3);
    for (const number of old) if (!wanted.includes(number)) this.windows.delete(number);
    this.stale = new Set(wanted);
    for (const number of wanted) this.fetch(number);
  }

  private get isLarge(): boolean {
    return this.extent.glimpses > 0;
  }
  private numberOf(frame: number): number {
    return Math.floor(frame / this.extent.length);
  }

  // What was wanted around another place is in the way of what is wanted now.
  private leave(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    this.wanted.clear();
    if (!this.isLarge) return;
    for (const [number, request] of this.pending) {
      if (this.stale.has(number)) continue;
      request.abort();
      this.pending.delete(number);
    }
  }

  private want(number: number): void {
    if (number < 0 || this.windows.has(number) || this.pending.has(number) || this.refused.has(number)) return;
    if (!this.isLarge) return this.fetch(number);
    this.wanted.add(number);
    // While it plays, the next window is fetched in time; after a jump, when the person stays.
    if (this.windows.has(this.place)) this.fetchWanted();
    else this.timer ||= window.setTimeout(() => this.fetchWanted(), REST);
  }

  private readonly goOn = (): void => {
    if (this.timer === 0) this.fetchWanted(); // else the person has just come
  };

  // The window of the place, then those after it, then those before it; false when all are here.
  private fetchWanted(): boolean {
    clearTimeout(this.timer);
    this.timer = 0;
    const order = (n: number) => (n >= this.place ? n - this.place : 1000 + this.place - n);
    const missing = [this.place, ...this.wanted].filter((n) => !this.windows.has(n) && !this.refused.has(n));
    const [next] = missing.sort((a, b) => order(a) - order(b));
    if (next === undefined) return false;
    if (this.pending.size > 0 || !this.lane.take(this.goOn)) return true; // goes on when it is free
    this.wanted.delete(next);
    this.fetch(next, () => this.lane.leave());
    return true;
  }

  // A frame by itself, when it is its turn.
  private look(frame: number): undefined {
    if (this.glimpsing.has(frame) || this.glimpsing.size >= AT_ONCE) return;
    this.glimpsing.add(frame);
    const generation = this.generation;
    this.fetchWindow(frame, frame, new AbortController().signal)
      .then((bytes) => {
        if (generation === this.generation) this.keep(this.glimpses, frame, bytes, this.extent.glimpses);
      })
      .catch((error: unknown) => this.failed(error))
      .finally(() => {
        if (generation === this.generation) this.glimpsing.delete(frame);
        this.loaded();
      });
  }

  private fetch(number: number, done: () => void = () => undefined): void {
    if (number < 0 || this.pending.has(number) || this.windows.has(number) && !this.stale.has(number)) {
      return done();
    }
    const request = new AbortController();
    this.pending.set(number, request);
    const generation = this.generation;
    const { length, windows } = this.extent;
    const first = number * length;
    this.fetchWindow(first, first + length - 1, request.signal)
      .finally(done)
      .then((bytes) => {
        if (generation !== this.generation || request.signal.aborted) return;
        this.keep(this.windows, number, bytes, windows);
        this.stale.delete(number);
        this.pending.delete(number);
        const more = this.isLarge && this.windows.has(this.place) && this.fetchWanted();
        if (!this.glimpses.has(this.frame)) this.loaded();
        else if (!more) this.completed();
      })
      .catch((error: unknown) => {
        if (generation !== this.generation || request.signal.aborted) return;
        this.pending.delete(number);
        if (error instanceof Refusal) this.refused.set(number, error);
        this.failed(error);
      });
  }

  private keep(where: Map<number, T>, key: number, bytes: ArrayBuffer, most: number): void {
    where.set(key, unpack(bytes) as Rows as T);
    while (where.size > most) where.delete(where.keys().next().value as number);
  }
}
