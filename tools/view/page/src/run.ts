// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A run as the page holds it: data, choices and clock, shared by all of its parts.

import { getJson } from './api';
import { Clock } from './clock';
import { FrameCache, Lane, extentOf } from './frameCache';
import type { BoxRows, TrajectoryRows } from './frames';
import { WINDOW_OF_EXPORT, type Source } from './source';
import type { Store } from './state';
import type { Edits, RunSession, SolveNews, Suspect, Versions } from './types';

export class Run {
  readonly clock: Clock;
  readonly boxes: FrameCache<BoxRows>;
  readonly before: FrameCache<TrajectoryRows>;
  readonly after: FrameCache<TrajectoryRows>;
  readonly truth: FrameCache<TrajectoryRows>;
  animals: string[];
  versions: Versions;
  edits: Edits;
  suspects: Suspect[] = [];
  solve: SolveNews | null = null;
  command: string;
  private job = -1;  // that the command line is of
  private watchers = new Set<() => void>();

  constructor(
    readonly source: Source,
    readonly store: Store,
  ) {
    const s = source.session;
    this.animals = s.versions.animals;
    this.versions = s.versions;
    this.edits = s.edits;
    this.command = s.solve.command;
    this.clock = new Clock(store, s.frames.first, s.frames.last, s.fps ?? 25);
    const extent = s.exported
      ? { length: WINDOW_OF_EXPORT, windows: 24, glimpses: 0 }
      : extentOf(this.animals.length);
    const lane = new Lane();
    const cache = <T extends BoxRows | TrajectoryRows>(what: string) =>
      new FrameCache<T>(
        extent,
        lane,
        (first, last, signal) => source.window(what, first, last, signal),
        () => this.clock.redraw(),
        () => this.clock.redrawSoon(),
        (error) => store.fail(error),
      );
    this.boxes = cache('boxes');
    this.before = cache('before');
    this.after = cache('after');
    this.truth = cache('truth');
    for (const [what, rows] of Object.entries(source.first.rows)) {
      this[what as 'boxes' | 'before' | 'after'].give(source.first.frame, rows);
    }
  }

  get session(): RunSession {
    return this.source.session;
  }
  // The flock that is shown.
  flock(): FrameCache<TrajectoryRows> {
    return this.store.get().table === 'after' ? this.after : this.before;
  }
  indexOf(id: string): number {
    return this.animals.indexOf(id);
  }

  // Told of news that is no choice of the person: edits, solves, suspects.
  watch(listener: () => void): () => void {
    this.watchers.add(listener);
    return () => this.watchers.delete(listener);
  }
  // The command line of a solve that was asked for; answers may come in another order.
  says(job: number, command: string): void {
    if (job < this.job) return;
    this.job = job;
    this.command = command;
    this.tell();
  }

  private tell(): void {
    for (const watcher of this.watchers) watcher();
    this.clock.redraw();
  }

  setVersions(versions: Versions): void {
    const before = this.versions;
    this.versions = versions;
    this.animals = versions.animals;
    if (versions.boxes !== before.boxes) this.boxes.renew();
    if (versions.before !== before.before) {
      this.before.renew();
      this.truth.renew();
    }
    if (versions.after !== before.after) {
      this.after.renew();
      if (before.after === 0 || this.store.get().table === 'before') {
        this.store.set({ table: 'after' });
      }
    }
    this.tell();
  }
  setEdits(edits: Edits): void {
    this.edits = edits;
    this.tell();
  }
  setSolve(news: SolveNews): void {
    if ((news.job ?? Infinity) < (this.solve?.job ?? 0)) return; // the last word of a cancelled one
    this.solve = news;
    this.tell();
  }
  async askSuspects(): Promise<void> {
    this.suspects = await getJson<Suspect[]>('api/suspects');
    this.tell();
  }
}
