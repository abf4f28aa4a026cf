// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plays frames at the film's pace, and asks for a drawing when something changed.

import type { Store } from './state';

const PATIENCE = 300; // ms that a drawing waits for what it needs
const SOON = 100; // ms
const LATEST = 3000; // ms
const SHOWN = 100; // ms that a browser may take to bring a drawing on the screen

export class Clock {
  private last = 0;
  private exact = 0; // the frame with its fraction
  private dirty = true;
  private drawers: (() => void)[] = [];
  private needs: ((frame: number) => boolean)[] = [];
  private asked: number; // the frame that is waited for,
  private since: number; // and since when [ms]
  private timer = 0;
  private readonly latest = performance.now() + LATEST;
  private haveDrawn: (() => void) | undefined; // until they are told
  private isInSight = false;
  // The frame to draw: the one that the person wants, or, while that changes faster than frames come,
  // one of a moment ago.
  frame: number;
  // Once the first pictures are in sight, whole if that does not take too long: what they do not need
  // can wait for them.
  readonly drawn = new Promise<void>((resolve) => (this.haveDrawn = resolve));

  constructor(
    private store: Store,
    readonly first: number,
    readonly end: number,
    readonly fps: number,
  ) {
    this.exact = this.asked = this.frame = store.get().frame;
    this.since = performance.now();
    store.watch((state, before) => {
      this.dirty = true;
      if (state.frame !== before.frame && Math.floor(this.exact) !== state.frame) {
        this.exact = state.frame;
      }
      // At once: with the next picture it would be asked for later.
      if (state.frame !== before.frame && this.has(this.asked)) this.ask(state.frame);
      if (state.playing && !before.playing) {
        this.last = performance.now();
        if (state.frame >= this.end) this.go(this.first);
      }
    });
    requestAnimationFrame((now) => this.tick(now));
  }

  onDraw(draw: () => void): void {
    this.drawers.push(draw);
  }
  // What a drawing of a frame needs: asks for it, and says whether it is here. Until all is, nothing
  // is drawn for a moment: one whole picture takes less time than several in part.
  onNeed(need: (frame: number) => boolean): void {
    this.needs.push(need);
  }
  redraw(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    this.dirty = true;
  }
  // With what else comes in the next moment: for what only completes a picture that is in sight.
  redrawSoon(): void {
    this.timer ||= window.setTimeout(() => this.redraw(), SOON);
  }
  go(frame: number): void {
    const at = Math.min(Math.max(Math.round(frame), this.first), this.end);
    this.exact = at;
    this.store.set({ frame: at });
  }
  step(frames: number): void {
    this.store.set({ playing: false });
    this.go(this.store.get().frame + frames);
  }

  private has(frame: number): boolean {
    return this.needs.map((need) => need(frame)).every(Boolean);
  }
  private ask(frame: number): boolean {
    if (frame !== this.asked) this.since = performance.now();
    this.asked = frame;
    return this.has(frame);
  }

  // Chooses the frame to draw; false: wait.
  private choose(wanted: number): boolean {
    if (this.has(this.asked)) {
      this.frame = wanted !== this.asked && this.has(wanted) ? wanted : this.asked;
      return true;
    }
    if (performance.now() - this.since < PATIENCE) return false;
    this.frame = wanted;
    return true;
  }

  private tick(now: number): void {
    const state = this.store.get();
    if (state.playing) {
      this.exact += ((now - this.last) / 1000) * this.fps * state.speed;
      if (this.exact >= this.end + 1) {
        if (state.loop) this.exact = this.first;
        else this.store.set({ playing: false, frame: this.end });
      }
      if (this.store.get().playing) this.store.set({ frame: Math.floor(this.exact) });
    }
    this.last = now;
    const wanted = this.store.get().frame;
    if (this.dirty && this.choose(wanted)) {
      for (const draw of this.drawers) draw();
      this.dirty = this.frame !== wanted;
      this.ask(wanted);
      this.isInSight = this.drawers.length > 0;
    }
    if (this.haveDrawn && this.isInSight && (this.has(this.frame) || now > this.latest)) {
      setTimeout(this.haveDrawn, SHOWN);
      this.haveDrawn = undefined;
    }
    requestAnimationFrame((next) => this.tick(next));
  }
}
