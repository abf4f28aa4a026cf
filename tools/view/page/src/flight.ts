// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The flock of a run in space: birds, trails, bars of depth's uncertainty along the line of sight,
// and another flock beside it as a ghost.

import * as THREE from 'three';

import { Birds } from './birds';
import { colourOf, ground } from './colours';
import { rowsOf, type TrajectoryRows } from './frames';
import { centreOf, poseAt } from './lens';
import { Lines } from './lines';
import type { Run } from './run';
import { Space } from './space';
import { isShown } from './state';

const MOST_VERTICES = 240000;
const MORE = 4000; // animals that may turn up in frames that were not looked at

export class FlightView {
  readonly space: Space;
  private birds: Birds;
  private ghosts: Birds;
  private trails = new Lines(MOST_VERTICES, 0.7);
  private bars = new Lines(40000, 0.85);
  private ring: THREE.Mesh;
  private seen = new Int32Array(0); // of each animal: the frame of its trail's end, and where
  private place = new Float32Array(0);
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
    this.ring = new THREE.Mesh(
      new THREE.TorusGeometry(1, 0.06, 8, 40),
      new THREE.MeshBasicMaterial({ color: 0xffb000 }),
    );
    this.space.world.add(this.birds.mesh, this.ghosts.mesh, this.trails.object, this.bars.object,
      this.ring);
    const paint = () => this.space.paint(store.get().dark, store.get().grid);
    paint();
    store.watch((state, before) => {
      if (state.dark !== before.dark || state.grid !== before.grid) paint();
      if (state.view !== before.view) this.space.look(state.view, state.frame);
    });
    clock.onNeed(() => run.flock().ahead(store.get().frame) !== undefined);
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

  // Birds are drawn larger than life where they would be specks.
  get birdSize(): number {
    return Math.max(this.wingspan, 0.03 * this.space.extent) * this.run.store.get().birdScale;
  }

  private forEach(rows: TrajectoryRows, frame: number, visit: (row: number, animal: number) => void) {
    const state = this.run.store.get();
    const [begin, end] = rowsOf(rows, frame);
    for (let r = begin; r < end; r++) {
      if (isShown(state, rows.animal[r])) visit(r, rows.animal[r]);
    }
  }

  draw(): void {
    const { run, space } = this;
    const state = run.store.get();
    const { frame } = state;
    const rows = run.flock().ahead(frame);
    space.aim(frame);
    const q = new THREE.Quaternion();
    this.birds.begin();
    this.bars.begin();
    this.ring.visible = false;
    const size = this.birdSize;
    const pose = run.session.camera ? poseAt(run.session.camera, frame) : null;
    const eye = pose ? centreOf(pose) : null;
    if (rows) {
      this.forEach(rows, frame, (r, animal) => {
        const [x, y, z] = rows.position.subarray(3 * r, 3 * r + 3);
        const o = rows.orientation;
        q.set(o[4 * r + 1], o[4 * r + 2], o[4 * r + 3], o[4 * r]).normalize();
        const chosen = animal === state.selected || animal === state.second;
        const grow = chosen ? 1.5 : animal === state.hovered ? 1.3 : 1;
        this.birds.add(x, y, z, q, size * grow, colourOf(animal, state.dark));
        if (chosen && animal === state.selected) {
          this.ring.visible = true;
          this.ring.position.set(x, y, z);
          this.ring.scale.setScalar(0.85 * size);
          this.ring.quaternion.copy(space.camera.quaternion);
          if (!(run.session.camera?.gravity ?? true)) {
            this.ring.quaternion.premultiply(
              new THREE.Quaternion().setFromRotationMatrix(space.world.matrixWorld).invert());
          }
          if (state.view === 'follow') {
            const at = space.toScene(new THREE.Vector3(x, y, z));
            const v = new THREE.Vector3(...rows.velocity.subarray(3 * r, 3 * r + 3));
            const along = v.transformDirection(space.world.matrixWorld);
            space.follow(at, along, size);
          }
        }
        const sd = rows.sd[r];
        if (state.bars && eye && sd > 0) {
          const d = [x - eye[0], y - eye[1], z - eye[2]];
          const far = Math.hypot(...d);
          const k = Math.min(sd / Math.max(far, 1e-9), 0.9);
          this.bars.add(x - k * d[0], y - k * d[1], z - k * d[2], x + k * d[0], y + k * d[1],
            z + k * d[2], colourOf(animal, state.dark));
        }
      });
    }
    this.birds.end();
    this.bars.end();
    this.drawTrails(frame);
    this.drawGhosts(frame, q, size);
    space.render();
    space.canvas.dataset.frame = rows ? String(frame) : '';
  }

  private drawTrails(frame: number): void {
    const state = this.run.store.get();
    this.trails.begin();
    const animals = this.run.animals.length;
    if (this.seen.length < animals) {
      this.seen = new Int32Array(2 * animals);
      this.place = new Float32Array(6 * animals);
    }
    const flock = this.run.flock();
    const { seen, place } = this;
    seen.fill(-1000);
    const budget = Math.floor(MOST_VERTICES / 2 / Math.max(this.run.animals.length, 1));
    const length = Math.min(state.trails, budget);
    for (let f = frame - length; f <= frame && length > 0; f++) {
      const rows = flock.near(Math.max(f, this.run.clock.first));
      if (!rows) continue;
      const { position } = rows;
      this.forEach(rows, f, (r, animal) => {
        if (animal >= seen.length) return;
        const [x, y, z] = [position[3 * r], position[3 * r + 1], position[3 * r + 2]];
        const at = 3 * animal;
        if (f - seen[animal] <= 4) {
          this.trails.add(place[at], place[at + 1], place[at + 2], x, y, z,
            colourOf(animal, state.dark));
        }
        seen[animal] = f;
        place[at] = x;
        place[at + 1] = y;
        place[at + 2] = z;
      });
    }
    this.trails.end();
  }

  private drawGhosts(frame: number, q: THREE.Quaternion, size: number): void {
    const state = this.run.store.get();
    this.ghosts.begin();
    const other =
      state.ghost === 'truth' ? this.run.truth : state.ghost === 'before' ? this.run.before : null;
    const rows = other?.ahead(frame);
    if (rows) {
      const [begin, end] = rowsOf(rows, frame);
      for (let r = begin; r < end; r++) {
        const o = rows.orientation;
        q.set(o[4 * r + 1], o[4 * r + 2], o[4 * r + 3], o[4 * r]).normalize();
        const [x, y, z] = rows.position.subarray(3 * r, 3 * r + 3);
        this.ghosts.add(x, y, z, q, size, ground(state.dark).ghost);
      }
    }
    this.ghosts.end();
  }

  private animalAt(x: number, y: number): number {
    const { frame } = this.run.store.get();
    const rows = this.run.flock().at(frame);
    let best = -1;
    let least = 18; // CSS px
    if (rows) {
      this.forEach(rows, frame, (r, animal) => {
        const [a, b, c] = rows.position.subarray(3 * r, 3 * r + 3);
        const p = this.space.onCanvas(a, b, c);
        const far = p ? Math.hypot(p[0] - x, p[1] - y) : Infinity;
        if (far < least) {
          least = far;
          best = animal;
        }
      });
    }
    return best;
  }
}
