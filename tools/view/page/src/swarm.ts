// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A running scene in space: animals, goals, predators, obstacles; and what a click or a drag in it
// means.

import * as THREE from 'three';

import { Birds, type Sight } from './birds';
import { colourOf, ground } from './colours';
import type { Look } from './live';
import { Discs, Lines } from './lines';
import { Shape, shadeOf, shadesOf } from './shape';
import { Space } from './space';
import type { Store, ViewName } from './state';
import type { SceneSession } from './types';

export interface Steering {
  attract(position: number[]): void;
  moveGoal(index: number, position: number[]): void;
  movePredator(index: number, position: number[]): void;
  lead(points: number[][]): void;
}

export class SwarmView {
  readonly space: Space;
  look: Look | null = null;
  private birds: Birds;
  private trails = new Lines(100000, 0.55);
  private goals = new Discs(64, 0.4);
  private fixed: Shape[] = []; // obstacles
  private box = new Lines(12, 0.5);
  private dirty = true;
  private past: Float32Array[] = [];
  private stroke: THREE.Vector3[] | null = null;
  private strokeLine = new Lines(2000, 1);
  private paths = new Lines(4096, 1);
  private species: number[] = []; // of each animal
  private followed = 0;
  private sizes: number[] = [];

  constructor(
    canvas: HTMLCanvasElement,
    private session: SceneSession,
    private store: Store,
    private steering: Steering,
  ) {
    this.space = new Space(canvas, session.camera, session.bounds, true, () => (this.dirty = true));
    session.species.forEach((s, k) => {
      for (let n = 0; n < s.count; n++) {
        this.species.push(k);
        this.sizes.push(s.wingspan);
      }
    });
    for (let n = 0; n < session.predators; n++) {
      this.species.push(-1);
      this.sizes.push(1.6 * (this.sizes[0] ?? 1));
    }
    this.birds = new Birds(this.species.length);
    for (const { vertices, triangles } of session.obstacles) {
      this.fixed.push(obstacle(vertices, triangles, this.space.sight()));
    }
    this.space.show(this.birds.shape, this.trails.shape, ...this.fixed, this.box.shape,
      this.paths.shape, this.goals.shape, this.strokeLine.shape);
    const paint = () => {
      this.space.paint(store.get().dark, store.get().grid);
      this.paintBox();
      this.dirty = true;
    };
    paint();
    this.showPaths(session.paths);
    store.watch((state, before) => {
      if (state.dark !== before.dark || state.grid !== before.grid) paint();
      if (state.view !== before.view) this.lookFrom(state.view);
      this.dirty = true;
    });
    if (session.camera) this.space.look('orbit', 1);
    this.listen(canvas);
    const loop = () => {
      if (this.dirty) this.draw();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  showPaths(paths: SceneSession['paths']): void {
    this.paths.begin();
    for (const line of paths) {
      for (let k = 1; k < line.length; k++) this.paths.add(...line[k - 1], ...line[k], '#e6820a');
    }
    this.paths.end();
    this.dirty = true;
  }

  take(look: Look): void {
    if (this.look && look.time < this.look.time) this.past = [];
    this.look = look;
    this.past.push(look.position);
    if (this.past.length > 40) this.past.shift();
    this.dirty = true;
  }

  private lookFrom(view: ViewName): void {
    this.space.look(view, 1);
    if (view !== 'follow' || !this.look) return;
    // Whoever is next to the middle of the flock.
    const { position, agents } = this.look;
    const at = (k: number) => new THREE.Vector3().fromArray(position, 3 * k);
    const middle = new THREE.Vector3();
    for (let k = 0; k < agents; k++) middle.addScaledVector(at(k), 1 / agents);
    this.followed = 0;
    for (let k = 1; k < agents; k++) {
      if (at(k).distanceTo(middle) < at(this.followed).distanceTo(middle)) this.followed = k;
    }
  }
  private follow(look: Look): void {
    if (this.store.get().view !== 'follow' || this.followed >= look.agents) return;
    const along = new THREE.Vector3().fromArray(look.velocity, 3 * this.followed);
    const at = new THREE.Vector3().fromArray(look.position, 3 * this.followed);
    this.space.follow(at, along, this.sizeOf(this.followed));
  }

  private paintBox(): void {
    const { low, high } = this.session.bounds;
    if (![...low, ...high].every(Number.isFinite)) return;
    const colour = ground(this.store.get().dark).ink;
    const corner = (k: number) => [0, 1, 2].map((axis) => ((k >> axis) & 1 ? high : low)[axis]) as
      [number, number, number];
    this.box.begin();
    for (let k = 0; k < 8; k++) {
      for (const bit of [1, 2, 4]) if (!(k & bit)) this.box.add(...corner(k), ...corner(k | bit), colour);
    }
    this.box.end();
  }

  private colourOfAnimal(k: number, dark: boolean): string {
    if (this.species[k] === -1) return '#e0402e';
    return colourOf(this.session.species.length > 1 ? this.species[k] : 0, dark);
  }
  private sizeOf(k: number): number {
    const least = this.species.length > 2000 ? 0.009 : 0.016;
    return Math.max(this.sizes[k] ?? 0.3, least * this.space.extent) * this.store.get().birdScale;
  }

  private draw(): void {
    this.dirty = false;
    const { look } = this;
    if (look) this.follow(look);
    this.space.aim(1);
    if (look) {
      this.drawAnimals(look);
      this.drawTrails(look);
      this.drawGoals(look);
      this.space.canvas.dataset.time = look.time.toFixed(3);
    }
    this.strokeLine.begin();
    for (let k = 1; this.stroke && k < this.stroke.length; k++) {
      const a = this.stroke[k - 1];
      const b = this.stroke[k];
      this.strokeLine.add(a.x, a.y, a.z, b.x, b.y, b.z, '#e6820a');
    }
    this.strokeLine.end();
    this.space.render();
  }

  // Each flies level along its velocity.
  private drawAnimals(look: Look): void {
    const { position: p, velocity: v } = look;
    const { dark } = this.store.get();
    this.birds.begin(this.space.sight(), look.agents, this.sizeOf(0));
    for (let k = 0; k < look.agents; k++) {
      const [x, y, z] = [v[3 * k], v[3 * k + 1], v[3 * k + 2]];
      const yaw = Math.atan2(y, x) / 2;
      const pitch = -Math.atan2(z, Math.hypot(x, y)) / 2;
      const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
      this.birds.add(p[3 * k], p[3 * k + 1], p[3 * k + 2], cy * cp, -sy * sp, cy * sp, sy * cp,
        this.sizeOf(k), this.colourOfAnimal(k, dark));
    }
    this.birds.end();
  }

  private drawTrails(look: Look): void {
    const state = this.store.get();
    this.trails.begin();
    const length = Math.min(state.trails, this.past.length - 1, Math.floor(90000 / Math.max(look.agents, 1)));
    for (let back = 0; back < length; back++) {
      const b = this.past[this.past.length - 1 - back];
      const a = this.past[this.past.length - 2 - back];
      if (a.length !== b.length) break;
      for (let k = 0; k < b.length; k += 3) {
        this.trails.add(a[k], a[k + 1], a[k + 2], b[k], b[k + 1], b[k + 2],
          this.colourOfAnimal(k / 3, state.dark));
      }
    }
    this.trails.end();
  }

  private drawGoals(look: Look): void {
    const [right, up] = this.space.facing();
    this.goals.begin();
    for (let k = 0; k < look.goals.length / 3; k++) {
      const reach = Math.max(this.session.goals[k]?.reach ?? 0, 0.015 * this.space.extent);
      this.goals.add(new THREE.Vector3().fromArray(look.goals, 3 * k), right, up, 0, reach, '#f0b429');
    }
    this.goals.end();
  }

  // The goal or predator at a place of the canvas, if there is one.
  private thingAt(x: number, y: number): { kind: 'goal' | 'predator'; index: number; at: THREE.Vector3 } | null {
    const { look } = this;
    if (!look) return null;
    const near = (p: ArrayLike<number>, k: number) => {
      const at = this.space.onCanvas(p[3 * k], p[3 * k + 1], p[3 * k + 2]);
      return at !== null && Math.hypot(at[0] - x, at[1] - y) < 22;
    };
    for (let k = 0; k < this.session.predators; k++) {
      const animal = look.agents - this.session.predators + k;
      if (near(look.position, animal)) {
        return { kind: 'predator', index: k, at: new THREE.Vector3().fromArray(look.position, 3 * animal) };
      }
    }
    for (let k = 0; k < look.goals.length / 3; k++) {
      if (near(look.goals, k)) {
        return { kind: 'goal', index: k, at: new THREE.Vector3().fromArray(look.goals, 3 * k) };
      }
    }
    return null;
  }

  private listen(canvas: HTMLCanvasElement): void {
    const placeOf = (e: PointerEvent): [number, number] => {
      const box = canvas.getBoundingClientRect();
      return [e.clientX - box.left, e.clientY - box.top];
    };
    // Level ground for what walks, the plane that faces the viewer for what flies.
    const flat = this.session.dimensions === 2;
    const toPlane = (p: [number, number], through: THREE.Vector3) => this.space.toPlane(...p, through, flat);
    canvas.addEventListener('pointerdown', (event) => {
      const start = placeOf(event);
      const thing = event.button === 0 ? this.thingAt(...start) : null;
      const draws = this.store.get().mode === 'sketch' && event.button === 0;
      const through = thing?.at ?? this.space.centre.clone();
      if (flat) through.z = 0;
      if (thing || draws) this.space.controls.enabled = false;
      if (draws) this.stroke = [];
      let moved = false;
      let sent = 0;
      const move = (e: PointerEvent) => {
        const now = placeOf(e);
        moved ||= Math.hypot(now[0] - start[0], now[1] - start[1]) > 4;
        const at = toPlane(now, through);
        if (!at || !moved) return;
        if (draws) {
          this.stroke?.push(at);
          this.dirty = true;
        } else if (thing && performance.now() - sent > 40) {
          sent = performance.now();
          if (thing.kind === 'goal') this.steering.moveGoal(thing.index, at.toArray());
          else this.steering.movePredator(thing.index, at.toArray());
        }
      };
      const up = (e: PointerEvent) => {
        removeEventListener('pointermove', move);
        removeEventListener('pointerup', up);
        this.space.controls.enabled = this.space.turns;
        if (draws) {
          const line = this.stroke ?? [];
          if (line.length > 2) this.steering.lead(line.map((p) => p.toArray()));
        } else if (!moved && !thing && e.button === 0) {
          const at = toPlane(start, through);
          if (at) this.steering.attract(at.toArray());
        }
      };
      addEventListener('pointermove', move);
      addEventListener('pointerup', up);
    }, { capture: true });
  }
}

// A surface that stands still, seen from both sides alike.
function obstacle(vertices: number[], triangles: number[], { up, sun }: Sight): Shape {
  const shape = new Shape('triangles', triangles.length, 0.55);
  const shades = shadesOf('#8f99a6');
  for (let k = 0; k + 2 < triangles.length; k += 3) {
    const [a, b, c] = [0, 1, 2].map((n) => new THREE.Vector3().fromArray(vertices, 3 * triangles[k + n]));
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    const shade = shades[shadeOf(Math.abs(normal.dot(up)), Math.abs(normal.dot(sun)))];
    for (const p of [a, b, c]) shape.add(p.x, p.y, p.z, shade);
  }
  shape.end();
  return shape;
}
