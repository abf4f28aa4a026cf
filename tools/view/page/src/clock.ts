// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plays frames at the film's pace, and asks for a drawing when something changed.

import type { Store } from './state';

const PATIENCE = 300; // ms that a drawing waits for what it needs

export class Clock {
  private last = 0;
  private exact = 0; // the frame with its fraction
  private dirty = true;
  private drawers: (() => void)[] = [];
  private needs: (() => boolean)[] = [];
  private waits = 0; // since when [ms]; 0: it does not
  private haveDrawn: () => void = () => undefined;
  // Once the first pictures are in sight: what they do not need can wait for them.
  readonly drawn = new Promise<void>((resolve) => (this.haveDrawn = resolve));

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
  // What a drawing needs: asks for it, and says whether it is here. Until all is, nothing is drawn for
  // a moment: one whole picture takes less time than several in part.
  onNeed(need: () => boolean): void {
    this.needs.push(need);
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

  private mustWait(now: number): boolean {
    if (this.needs.map((need) => need()).every(Boolean)) return false;
    this.waits ||= now;
    return now - this.waits < PATIENCE;
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
    if (this.dirty && !this.mustWait(now)) {
      this.dirty = false;
      this.waits = 0;
      for (const draw of this.drawers) draw();
      if (this.drawers.length > 0) setTimeout(this.haveDrawn);
    }
    requestAnimationFrame((next) => this.tick(next));
  }
}
