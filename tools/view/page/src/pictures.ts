// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The film's pictures: asked for when a frame is looked at and before it plays, kept for a while.

import type { Run } from './run';

export interface Picture {
  frame: number;
  bitmap: ImageBitmap | null;
}

const KEPT = 48;
const AT_ONCE = 4; // requests
const WIDEST = 1920; // px
const NEAR = 8; // frames: what is farther is not worth waiting for

export class Pictures {
  private kept = new Map<number, Picture>();
  private waiting = new Map<number, AbortController>();
  private last: Picture | null = null;

  constructor(private run: Run) {}

  // The picture to show for a frame: its own if it is here, else the one shown before. Those that
  // come next are made ready.
  show(frame: number, playing: boolean): Picture | null {
    const { source } = this.run;
    const wanted = source.pictured(frame);
    this.last = this.kept.get(wanted) ?? this.last;
    for (const [waited, abort] of this.waiting) {
      if (Math.abs(waited - wanted) > NEAR) abort.abort();
    }
    this.ask(wanted);
    for (let k = 1; k <= (playing ? 6 : 1); k++) {
      if (this.waiting.size < AT_ONCE) this.ask(source.pictured(frame + k));
    }
    return this.last;
  }

  private ask(frame: number): void {
    const { session, source, clock, store } = this.run;
    if (!session.footage || frame < 1 || frame > session.footage.frames) return;
    if (this.kept.has(frame) || this.waiting.has(frame)) return;
    const abort = new AbortController();
    this.waiting.set(frame, abort);
    source
      .picture(frame, Math.min(session.footage.width, WIDEST), abort.signal)
      .then((blob) => createImageBitmap(blob))
      .then((bitmap) => {
        this.keep({ frame, bitmap });
        clock.redraw();
      })
      .catch((error: unknown) => {
        if (!abort.signal.aborted) store.fail(error);
      })
      .finally(() => this.waiting.delete(frame));
  }

  private keep(picture: Picture): void {
    this.kept.set(picture.frame, picture);
    while (this.kept.size > KEPT) {
      const oldest = this.kept.keys().next().value as number;
      if (this.last?.frame !== oldest) this.kept.get(oldest)?.bitmap?.close();
      this.kept.delete(oldest);
    }
  }
}
