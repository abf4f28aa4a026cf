// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A view into space: camera, light, ground grid in metres, and ways to look. The world is drawn with
// z up; where gravity is not known it is the film camera's axes, turned so that its up is up.

import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import type { Sight } from './birds';
import { ground } from './colours';
import { GlPainter } from './glPainter';
import { canvasOver, onCard } from './graphics';
import { centreOf, poseAt } from './lens';
import { Lines } from './lines';
import type { Painter, Placed, Shape } from './shape';
import { SoftPainter } from './softPainter';
import type { ViewName } from './state';
import type { Bounds, CameraInfo } from './types';

// A round length: 1, 2 or 5 times a power of ten, about `length`.
export function roundLength(length: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(length, 1e-6)));
  const digit = length / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

const REST = 250; // ms
const MANY = 800000; // pixels

export class Space {
  readonly world = new THREE.Matrix4(); // scene from world
  readonly camera = new THREE.PerspectiveCamera(45, 1, 0.05, 20000);
  readonly controls: OrbitControls;
  readonly centre = new THREE.Vector3(); // of the flock, in the world frame
  extent = 10; // [m]
  gridStep = 1; // [m]
  private grid: Lines | null = null;
  private frustum: Lines | null = null;
  private sun = new THREE.Vector3(0.4, -0.6, 1).normalize(); // towards it
  private view: ViewName = 'orbit';
  private back = '#000000';
  private painter: Painter;
  picture: HTMLCanvasElement; // that the painter draws
  private size = [0, 0]; // of the last drawing [CSS px]
  private drawn = 0; // when [ms]
  private rests = false;
  private timer = 0;
  private shapes: Shape[] = []; // in the world

  constructor(
    readonly canvas: HTMLCanvasElement,
    private film: CameraInfo | null,
    bounds: Bounds | null,
    upIsUp: boolean,
    private redraw: () => void,
  ) {
    this.painter = new SoftPainter(canvas);
    this.picture = canvas;
    onCard(() => this.drawByCard());
    this.camera.up.set(0, 0, 1);
    // x right, y down, z forward  ->  x right, y forward, z up
    if (!upIsUp) this.world.set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
    if (bounds) {
      const low = new THREE.Vector3().fromArray(bounds.low);
      const high = new THREE.Vector3().fromArray(bounds.high);
      this.centre.addVectors(low, high).multiplyScalar(0.5);
      this.extent = Math.max(high.clone().sub(low).length(), 1);
    }
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', redraw);
    this.controls.zoomToCursor = true;
    // What the crosshair does in the picture turns nothing: there are keys for that.
    const isCrosshair = (event: Event) => !event.isTrusted;
    canvas.addEventListener('pointerdown', (e) => {
      if (isCrosshair(e)) this.controls.enabled = false;
    }, { capture: true });
    canvas.addEventListener('pointerup', (e) => {
      if (isCrosshair(e)) this.controls.enabled = this.turns;
    });
    new ResizeObserver(() => {
      if (canvas.clientWidth !== this.size[0] || canvas.clientHeight !== this.size[1]) redraw();
    }).observe(canvas);
    this.look('orbit', 1);
  }

  private drawByCard(): void {
    const over = canvasOver(this.canvas);
    try {
      this.painter = new GlPainter(over);
    } catch {
      return over.remove(); // it draws no more pictures: the processor goes on
    }
    this.picture = over;
    this.picture.addEventListener('webglcontextrestored', this.redraw);
    this.redraw();
  }
  get isDrawnByProcessor(): boolean {
    return this.painter instanceof SoftPainter;
  }

  // Whether the person turns it, and not what is looked at.
  get turns(): boolean {
    return this.view !== 'camera' && this.view !== 'follow';
  }
  toScene(v: THREE.Vector3): THREE.Vector3 {
    return v.applyMatrix4(this.world);
  }
  // Shapes that are in the world frame, drawn in this order.
  show(...shapes: Shape[]): void {
    this.shapes.push(...shapes);
  }

  paint(dark: boolean, showGrid: boolean): void {
    const colours = ground(dark);
    this.back = colours.back;
    this.gridStep = roundLength(this.extent / 12);
    this.grid = this.makeGrid(colours.ink, colours.grid);
    this.grid.shape.visible = showGrid;
    this.frustum = this.film ? this.makeFrustum(this.film, colours.ink) : null;
  }

  // Level lines below the flock, the two in the middle darker.
  private makeGrid(middle: string, other: string): Lines {
    const step = this.gridStep;
    const half = Math.ceil((1.6 * this.extent) / step / 2);
    const lines = new Lines(4 * half + 2, 1);
    const reach = half * step;
    lines.begin();
    for (let k = -half; k <= half; k++) {
      const colour = k === 0 ? middle : other;
      lines.add(k * step, -reach, 0, k * step, reach, 0, colour);
      lines.add(-reach, k * step, 0, reach, k * step, 0, colour);
    }
    lines.end();
    const centre = this.toScene(this.centre.clone());
    const snap = (x: number) => Math.round(x / step) * step;
    lines.shape.matrix.makeTranslation(snap(centre.x), snap(centre.y),
      snap(Math.min(0, centre.z - this.extent / 2)));
    return lines;
  }

  private makeFrustum(film: CameraInfo, colour: string): Lines {
    const d = 0.12 * this.extent;
    const corner = (u: number, v: number): [number, number, number] =>
      [((u - film.cx) / film.fx) * d, ((v - film.cy) / film.fy) * d, d];
    const c = [corner(0, 0), corner(film.width, 0), corner(film.width, film.height), corner(0, film.height)];
    const lines = new Lines(8, 1);
    lines.begin();
    for (let k = 0; k < 4; k++) {
      lines.add(0, 0, 0, ...c[k], colour);
      lines.add(...c[k], ...c[(k + 1) % 4], colour);
    }
    lines.end();
    return lines;
  }

  private worldFromFilm(frame: number): THREE.Matrix4 {
    const pose = poseAt(this.film as CameraInfo, frame);
    const m = new THREE.Matrix4();
    m.set(...(pose as [number, number, number, number, number, number, number, number, number,
      number, number, number]), 0, 0, 0, 1);
    return m.invert();
  }

  // Where to stand: around, above, beside, or at the film's camera.
  look(view: ViewName, frame: number): void {
    const middle = this.toScene(this.centre.clone());
    const far = 1.25 * this.extent;
    this.view = view;
    this.controls.enabled = this.turns;
    this.camera.fov = view === 'top' || view === 'side' ? 12 : 45;
    const away = view === 'top' || view === 'side' ? (far * 45) / 12 : far;
    const from = new THREE.Vector3(0.75, -1, 0.55).normalize();
    if (this.film && view !== 'camera') {
      // Aside of the film's own line of sight, where depth is seen.
      const eye = this.toScene(new THREE.Vector3(...centreOf(poseAt(this.film, frame))));
      const line = middle.clone().sub(eye).setZ(0).normalize();
      const right = new THREE.Vector3(line.y, -line.x, 0);
      if (line.lengthSq() > 0.5) {
        from.copy(right).multiplyScalar(0.85).addScaledVector(line, -0.7).setZ(0.5).normalize();
        if (view === 'side') from.copy(right);
      }
    } else if (view === 'side') {
      from.set(0, -1, 0);
    }
    if (view === 'top') from.set(0, -1e-4, 1);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(from, away);
    this.camera.up.set(0, 0, 1);
    this.controls.update();
    this.redraw();
  }

  // About the middle, by keys: `turn` [rad] to the right, and nearer by a factor.
  move(turn: number, nearer: number): void {
    if (!this.controls.enabled) return;
    const { target } = this.controls;
    const from = this.camera.position.clone().sub(target);
    from.applyAxisAngle(this.camera.up, turn).multiplyScalar(1 / nearer);
    this.camera.position.copy(target).add(from);
    this.controls.update();
    this.redraw();
  }

  // Behind an animal and above it, flying along.
  follow(position: THREE.Vector3, velocity: THREE.Vector3, size: number): void {
    const back = velocity.clone().normalize();
    const away = Math.max(9 * size, 0.05 * this.extent);
    const wanted = position.clone().addScaledVector(back, -away);
    wanted.z += 0.35 * away;
    this.camera.position.lerp(wanted, this.camera.position.distanceTo(wanted) > 4 * away ? 1 : 0.15);
    this.controls.target.copy(position);
    this.camera.lookAt(position);
  }

  // Places the camera for a frame; what faces the viewer is placed after it.
  aim(frame: number): void {
    const { canvas, camera } = this;
    camera.aspect = Math.max(canvas.clientWidth, 1) / Math.max(canvas.clientHeight, 1);
    camera.near = this.extent / 2000;
    camera.far = 60 * this.extent;
    if (this.frustum) {
      this.frustum.shape.matrix.copy(this.worldFromFilm(frame));
      this.frustum.shape.visible = this.view !== 'camera';
    }
    if (this.view === 'camera' && this.film) this.placeAtFilm(frame);
    else camera.updateProjectionMatrix();
  }

  // How the flock is seen and lit, in the world frame; after aim().
  sight(): Sight {
    const inverse = this.world.clone().invert();
    const away = this.camera.position.distanceTo(this.toScene(this.centre.clone()));
    const focal = (this.camera.projectionMatrix.elements[5] * this.canvas.clientHeight) / 2;
    return {
      eye: this.camera.position.clone().applyMatrix4(inverse),
      up: new THREE.Vector3(0, 0, 1).transformDirection(inverse),
      sun: this.sun.clone().transformDirection(inverse),
      pixels: focal / Math.max(away, 1e-6),
    };
  }

  // Right and up of who looks, in the world frame.
  facing(): [THREE.Vector3, THREE.Vector3] {
    this.camera.updateMatrixWorld();
    const inverse = this.world.clone().invert();
    const axis = (k: number) =>
      new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k).transformDirection(inverse);
    return [axis(0), axis(1)];
  }

  render(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.size = [width, height];
    const inWorld = (shape: Shape): Placed => ({ shape, matrix: this.world.clone().multiply(shape.matrix) });
    const placed = this.shapes.map(inWorld);
    if (this.frustum) placed.push(inWorld(this.frustum.shape));
    if (this.grid) placed.push({ shape: this.grid.shape, matrix: this.grid.shape.matrix });
    const ratio = this.ratio(width * height);
    this.painter.paint(placed, this.camera, this.back, Math.max(Math.round(width * ratio), 1),
      Math.max(Math.round(height * ratio), 1));
  }

  // Of drawn pixels to those of the page. Where the processor draws many of them, they are coarse
  // while the picture changes, and fine once it rests.
  private ratio(pixels: number): number {
    if (!this.isDrawnByProcessor) return Math.min(devicePixelRatio, 2);
    const now = performance.now();
    const moves = now - this.drawn < REST && !this.rests;
    this.drawn = now;
    clearTimeout(this.timer);
    this.rests = false;
    if (pixels < MANY || !moves) return 1;
    this.timer = window.setTimeout(() => {
      this.rests = true;
      this.redraw();
    }, REST);
    return 0.5;
  }

  // The film's own view: its pose, and its intrinsics as the projection, letter-boxed.
  private placeAtFilm(frame: number): void {
    const film = this.film as CameraInfo;
    const { camera } = this;
    const flip = new THREE.Matrix4().makeScale(1, -1, -1); // OpenCV's axes to OpenGL's
    const pose = this.world.clone().multiply(this.worldFromFilm(frame)).multiply(flip);
    pose.decompose(camera.position, camera.quaternion, camera.scale);
    const aspect = camera.aspect;
    const w = Math.max(film.width, film.height * aspect);
    const h = w / aspect;
    const left = film.cx + (w - film.width) / 2;
    const top = film.cy + (h - film.height) / 2;
    const n = camera.near;
    camera.projectionMatrix.makePerspective(
      (-left * n) / film.fx, ((w - left) * n) / film.fx,
      (top * n) / film.fy, (-(h - top) * n) / film.fy, n, camera.far,
    );
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }

  // A place of the canvas (CSS px) in the plane through `through` that faces the viewer, or
  // the level one; world frame.
  toPlane(x: number, y: number, through: THREE.Vector3, level: boolean): THREE.Vector3 | null {
    const ray = new THREE.Raycaster();
    const at = new THREE.Vector2((2 * x) / this.canvas.clientWidth - 1,
      1 - (2 * y) / this.canvas.clientHeight);
    ray.setFromCamera(at, this.camera);
    const normal = level
      ? new THREE.Vector3(0, 0, 1)
      : this.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through);
    const hit = ray.ray.intersectPlane(plane, new THREE.Vector3());
    if (!hit) return null;
    return hit.applyMatrix4(this.world.clone().invert());
  }

  // Where a point of the world is on the canvas [CSS px].
  onCanvas(x: number, y: number, z: number): [number, number] | null {
    const p = this.toScene(new THREE.Vector3(x, y, z)).project(this.camera);
    if (p.z > 1 || p.z < -1) return null;
    return [((p.x + 1) / 2) * this.canvas.clientWidth, ((1 - p.y) / 2) * this.canvas.clientHeight];
  }
}
