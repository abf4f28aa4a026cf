// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The flock of a run in space: birds, trails, bars of depth's uncertainty along the line of sight,
// and another flock beside it as a ghost.

import * as THREE from 'three';

import { Birds, type Sight } from './birds';
import { colourOf, ground } from './colours';
import { rowOf, rowsOf, type TrajectoryRows } from './frames';
import { centreOf, poseAt } from './lens';
import { Discs, Lines } from './lines';
import type { Run } from './run';
import { Space } from './space';
import { isShown } from './state';

const MORE = 4000; // animals that may turn up in frames that were not looked at
const MOST_LINES = 120000; // of all trails
const MOST_IN_SOFTWARE = 16000; // of all trails, where the processor draws them

export class FlightView {
  readonly space: Space;
  private birds: Birds;
  private ghosts: Birds;
  private trails = new Lines(MOST_LINES, 0.7);
  private bars = new Lines(20000, 0.85);
  private ring = new Discs(1, 1);
  private seen = new Int32Array(0); // of each animal: the frame of its trail's end, and where
  private place = new Float32Array(0);
  private fits = false;
  onGrid: ((step: number) => void) | null = null; // hears its new width [m]
  readonly wingspan: number;

  constructor(
    canvas: HTMLCanvasElement,
    private run: Run,
  ) {
    const s = run.session;
    const { store, clock } = run;
    this.space = new Space(canvas, s.camera, s.bounds, s.camera?.gravity ?? true, () =>
      clock.redraw(),
    );
    const stated = parseFloat(String(s.solve.values.wingspan ?? ''));
    this.wingspan = stated > 0 ? stated : 0.6;
    const most = run.animals.length + MORE;
    this.birds = new Birds(most);
    this.ghosts = new Birds(most, 0.35);
    this.space.show(this.birds.shape, this.ring.shape, this.bars.shape, this.trails.shape,
      this.ghosts.shape);
    const paint = () => this.space.paint(store.get().dark, store.get().grid);
    paint();
    store.watch((state, before) => {
      if (state.dark !== before.dark || state.grid !== before.grid) paint();
      if (state.view !== before.view) {
        this.space.look(state.view, state.frame);
        if (state.view === 'follow' && state.selected < 0) this.choose(state.frame);
      }
    });
    clock.onNeed((frame) => run.flock().ahead(frame) !== undefined);
    clock.onDraw(() => this.draw());
    let start: [number, number] = [0, 0];
    canvas.addEventListener('pointerdown', (e) => (start = [e.clientX, e.clientY]));
    canvas.addEventListener('pointerup', (e) => {
      if (Math.hypot(e.clientX - start[0], e.clientY - start[1]) > 4) return;
      const box = canvas.getBoundingClientRect();
      const animal = this.animalAt(e.clientX - box.left, e.clientY - box.top);
      store.set(e.shiftKey ? { second: animal } : { selected: animal, second: -1 });
    });
  }

  // Brings the flock into sight, once its rows are here.
  fit(): void {
    this.fits = true;
    this.run.clock.redraw();
  }
  private fitNow(rows: TrajectoryRows): void {
    const box = new THREE.Box3();
    for (let r = 0; r < rows.animal.length; r++) box.expandByPoint(placeOf(rows, r));
    const { store } = this.run;
    this.fits = false;
    if (box.isEmpty()) return;
    box.getCenter(this.space.centre);
    this.space.extent = Math.max(box.getSize(new THREE.Vector3()).length(), 1);
    this.space.paint(store.get().dark, store.get().grid);
    this.space.look(store.get().view, store.get().frame);
    this.onGrid?.(this.space.gridStep);
  }

  // Somebody to fly along with.
  private choose(frame: number): void {
    const { store } = this.run;
    const rows = this.run.flock().at(frame);
    const [begin, end] = rows ? rowsOf(rows, frame) : [0, 0];
    for (let r = begin; rows && r < end; r++) {
      if (!isShown(store.get(), rows.animal[r])) continue;
      store.set({ selected: rows.animal[r], second: -1 });
      return;
    }
  }

  // Birds are drawn larger than life where they would be specks.
  get birdSize(): number {
    return Math.max(this.wingspan, 0.03 * this.space.extent) * this.run.store.get().birdScale;
  }

  draw(): void {
    const { run, space } = this;
    const { frame } = run.clock;
    const rows = run.flock().ahead(frame);
    if (rows && this.fits && run.flock().isNew(frame)) this.fitNow(rows);
    this.follow(rows, frame);
    space.aim(frame);
    const sight = space.sight();
    this.drawBirds(rows, frame, sight);
    this.drawBars(rows, frame);
    this.drawRing(rows, frame);
    this.drawTrails(frame);
    this.drawGhosts(frame, sight);
    space.render();
    space.canvas.dataset.frame = rows ? String(frame) : '';
  }

  private follow(rows: TrajectoryRows | undefined, frame: number): void {
    const { selected, view } = this.run.store.get();
    const r = rows && view === 'follow' ? rowOf(rows, frame, selected) : -1;
    if (!rows || r < 0) return;
    const at = this.space.toScene(placeOf(rows, r));
    const along = new THREE.Vector3().fromArray(rows.velocity, 3 * r);
    this.space.follow(at, along.transformDirection(this.space.world), this.birdSize);
  }

  private drawBirds(rows: TrajectoryRows | undefined, frame: number, sight: Sight): void {
    const state = this.run.store.get();
    const size = this.birdSize;
    const [begin, end] = rows ? rowsOf(rows, frame) : [0, 0];
    this.birds.begin(sight, end - begin, size);
    for (let r = begin; rows && r < end; r++) {
      const animal = rows.animal[r];
      if (!isShown(state, animal)) continue;
      const chosen = animal === state.selected || animal === state.second;
      const grow = chosen ? 1.5 : animal === state.hovered ? 1.3 : 1;
      const { position: p, orientation: q } = rows;
      this.birds.add(p[3 * r], p[3 * r + 1], p[3 * r + 2], q[4 * r], q[4 * r + 1], q[4 * r + 2],
        q[4 * r + 3], size * grow, colourOf(animal, state.dark));
    }
    this.birds.end();
  }

  // One standard deviation of depth to both sides, along the line of sight.
  private drawBars(rows: TrajectoryRows | undefined, frame: number): void {
    const state = this.run.store.get();
    const { camera } = this.run.session;
    this.bars.begin();
    if (rows && camera && state.bars) {
      const [ex, ey, ez] = centreOf(poseAt(camera, frame));
      const [begin, end] = rowsOf(rows, frame);
      for (let r = begin; r < end; r++) {
        if (!isShown(state, rows.animal[r]) || !(rows.sd[r] > 0)) continue;
        const [x, y, z] = [rows.position[3 * r], rows.position[3 * r + 1], rows.position[3 * r + 2]];
        const [dx, dy, dz] = [x - ex, y - ey, z - ez];
        const k = Math.min(rows.sd[r] / Math.max(Math.hypot(dx, dy, dz), 1e-9), 0.9);
        this.bars.add(x - k * dx, y - k * dy, z - k * dz, x + k * dx, y + k * dy, z + k * dz,
          colourOf(rows.animal[r], state.dark));
      }
    }
    this.bars.end();
  }

  private drawRing(rows: TrajectoryRows | undefined, frame: number): void {
    const { space, ring } = this;
    const { selected } = this.run.store.get();
    const r = rows ? rowOf(rows, frame, selected) : -1;
    ring.begin();
    if (rows && r >= 0 && isShown(this.run.store.get(), selected)) {
      const [right, up] = space.facing();
      ring.add(placeOf(rows, r), right, up, 0.8 * this.birdSize, 0.9 * this.birdSize, '#ffb000');
    }
    ring.end();
  }

  // Through the frames that are multiples of a stride, so that a trail stays where it is while the
  // flock moves on: a large flock's have few points each.
  private drawTrails(frame: number): void {
    const { run, trails } = this;
    const state = run.store.get();
    const animals = Math.max(run.animals.length, 1);
    const shown = state.solo && state.selected >= 0 ? 2 : animals;
    const most = (this.space.isDrawnByProcessor ? MOST_IN_SOFTWARE : MOST_LINES) / shown;
    const stride = Math.max(Math.ceil(state.trails / Math.max(most - 1, 1)), 1);
    if (this.seen.length < animals) {
      this.seen = new Int32Array(2 * animals);
      this.place = new Float32Array(6 * animals);
    }
    const { seen, place } = this;
    seen.fill(-1000);
    trails.begin();
    const first = Math.max(frame - state.trails, run.clock.first);
    for (let f = first; f <= frame && state.trails > 0; f++) {
      if (f !== first && f !== frame && f % stride !== 0) continue;
      const rows = run.flock().near(f);
      if (!rows) continue;
      const { position, animal } = rows;
      const [begin, end] = rowsOf(rows, f);
      for (let r = begin; r < end; r++) {
        const a = animal[r];
        if (a >= seen.length || !isShown(state, a)) continue;
        const [x, y, z] = [position[3 * r], position[3 * r + 1], position[3 * r + 2]];
        if (f - seen[a] <= stride + 3) {
          trails.add(place[3 * a], place[3 * a + 1], place[3 * a + 2], x, y, z, colourOf(a, state.dark));
        }
        seen[a] = f;
        place[3 * a] = x;
        place[3 * a + 1] = y;
        place[3 * a + 2] = z;
      }
    }
    trails.end();
  }

  private drawGhosts(frame: number, sight: Sight): void {
    const { store, truth, before } = this.run;
    const state = store.get();
    const other = state.ghost === 'truth' ? truth : state.ghost === 'before' ? before : null;
    const rows = other?.ahead(frame);
    const [begin, end] = rows ? rowsOf(rows, frame) : [0, 0];
    this.ghosts.begin(sight, end - begin, this.birdSize);
    for (let r = begin; rows && r < end; r++) {
      const { position: p, orientation: q } = rows;
      this.ghosts.add(p[3 * r], p[3 * r + 1], p[3 * r + 2], q[4 * r], q[4 * r + 1], q[4 * r + 2],
        q[4 * r + 3], this.birdSize, ground(state.dark).ghost);
    }
    this.ghosts.end();
  }

  private animalAt(x: number, y: number): number {
    const state = this.run.store.get();
    const { frame } = this.run.clock;
    const rows = this.run.flock().at(frame);
    let best = -1;
    let least = 18; // CSS px
    const [begin, end] = rows ? rowsOf(rows, frame) : [0, 0];
    for (let r = begin; rows && r < end; r++) {
      if (!isShown(state, rows.animal[r])) continue;
      const p = this.space.onCanvas(...placeOf(rows, r).toArray());
      const far = p ? Math.hypot(p[0] - x, p[1] - y) : Infinity;
      if (far < least) {
        least = far;
        best = rows.animal[r];
      }
    }
    return best;
  }
}

const placeOf = (rows: TrajectoryRows, r: number): THREE.Vector3 =>
  new THREE.Vector3().fromArray(rows.position, 3 * r);
