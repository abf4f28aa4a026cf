// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plays frames at the film's pace, and asks for a drawing when something changed.

import type { Store } from './state';

export class Clock {
  private last = 0;
  private exact = 0; // the frame with its fraction
  private dirty = true;
  private drawers: (() => void)[] = [];

  constructor(
    private store: Store,
    readonly first: number,
    readonly end: number,
    readonly fps: number,
  ) {
    this.exact = store.get().frame;
    store.watch((state, before) => {
      this.dirty = true;
      if (state.frame !== before.frame && Math.floor(this.exact) !== state.frame) {
        this.exact = state.frame;
      }
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
  redraw(): void {
    this.dirty = true;
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
    if (this.dirty) {
      this.dirty = false;
      for (const draw of this.drawers) draw();
    }
    requestAnimationFrame((next) => this.tick(next));
  }
}
